# Completion of burnish's options, scene files and, after -set, scene keys; N in a key stands for a place in a list.
_burnish() {
  local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD - 1]}
  case $last in
  -import) COMPREPLY=($(compgen -f -X '!*.inp' -- "$word") $(compgen -d -S / -- "$word")) ;;
  -explain) COMPREPLY=($(compgen -W "all $("${COMP_WORDS[0]}" -explain all 2>/dev/null | sed -n 's/^\(B[0-9]*\)  .*/\1/p')" -- "$word")) ;;
  -o | -restart | -evaluate) COMPREPLY=($(compgen -d -- "$word")) ;;
  -set)
    compopt -o nospace 2>/dev/null
    COMPREPLY=($(compgen -S = -W "$("${COMP_WORDS[0]}" -help 2>/dev/null | sed -n 's/^  \([A-Za-z_][A-Za-z0-9_.|]*\): .*/\1/p')" -- "$word"))
    ;;
  *)
    if [[ $word == -* ]]; then
      COMPREPLY=($(compgen -W "$("${COMP_WORDS[0]}" -help 2>/dev/null | sed '/^Scene file/,$d' | grep -oE '(^| )-[a-z_]+' | sort -u)" -- "$word"))
    else
      COMPREPLY=($(compgen -f -X '!*.y*ml' -- "$word") $(compgen -d -S / -- "$word"))
    fi
    ;;
  esac
}
complete -F _burnish burnish
