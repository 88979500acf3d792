# For the job scripts: one link of a chain of jobs that takes a run to its end. Sourced; wants
#   SCENE, DIR       scene file, directory of the results
#   BURNISH          the program and its own options, an array
#   LAUNCH           what starts it on all ranks, an array
#   resubmit         a command that puts the next link, or this job again, into the queue
# shellcheck shell=bash

# run_link: goes on from DIR's checkpoint, or begins; ends with burnish's exit status. TERM and USR1 to the job script end the run after the current step,
# with a checkpoint: the launcher runs in the background, as bash looks at signals between commands only, and gets USR1, as many launchers kill
# their ranks a second after a TERM.
run_link() {
  local command=("$SCENE" -o "$DIR") launcher='' asked status
  [ ! -e "$DIR/checkpoint.h5" ] || command=(-restart "$DIR")
  trap 'asked=1; [ -z "$launcher" ] || kill -USR1 "$launcher" 2>/dev/null' TERM USR1
  "${LAUNCH[@]}" "${BURNISH[@]}" "${command[@]}" &
  launcher=$!
  while asked=; do
    wait "$launcher"
    status=$?
    if [ -z "$asked" ] || [ "$status" -le 128 ]; then break; fi # else a signal ended the wait, not the run
  done
  trap - TERM USR1
  return "$status"
}

# run_chain: one link, and the next one queued if it was stopped; a run that stops without a step taken is not queued again.
run_chain() {
  local before status
  before=$(stat -c %Y.%i "$DIR/checkpoint.h5" 2>/dev/null)
  run_link
  status=$?
  if [ "$status" -eq 3 ] && [ "$before" != "$(stat -c %Y.%i "$DIR/checkpoint.h5" 2>/dev/null)" ]; then
    resubmit || return
    return 0
  fi
  return "$status"
}
