# One link of a chain of jobs that takes a run to its end. The job scripts source this file. They set
#   SCENE, DIR       scene file, directory of the results
#   BURNISH          the program and its own options, an array
#   LAUNCH           what starts it on all ranks, an array
#   resubmit         a command that puts the next link, or this job again, into the queue
# shellcheck shell=bash

# run_link: begins the run, or goes on from the checkpoint in DIR. It returns the exit status of burnish. TERM and
# USR1 to the job script end the run after the current step, with a checkpoint. The launcher runs in the background,
# because bash handles signals only between commands. It gets USR1, because many launchers kill their ranks a second
# after a TERM.
run_link() {
  local command=("$SCENE" -o "$DIR") launcher='' asked status
  [ ! -e "$DIR/checkpoint.h5" ] || command=(-restart "$DIR")
  trap 'asked=1; [ -z "$launcher" ] || kill -USR1 "$launcher" 2>/dev/null' TERM USR1
  "${LAUNCH[@]}" "${BURNISH[@]}" "${command[@]}" &
  launcher=$!
  while asked=; do
    wait "$launcher"
    status=$?
    if [ -z "$asked" ] || [ "$status" -le 128 ]; then break; fi # otherwise a signal ended the wait, not the run
  done
  trap - TERM USR1
  return "$status"
}

# run_chain: runs one link and queues the next one if the run was stopped. A run that was stopped before it took a
# step is not queued again.
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
