# Completion of freeplay in bash: the program itself says how a line can go on.
_freeplay() {
  local words word at
  read -a words <<<"${COMP_LINE:0:COMP_POINT}"
  [[ ${COMP_LINE:COMP_POINT-1:1} != ' ' ]] || words+=('')
  word=${words[-1]}
  mapfile -t COMPREPLY < <("${words[0]/#\~\//$HOME/}" complete "${words[@]:1}" 2>/dev/null)
  # bash puts what is found in place of the part after the last '=' or ':'.
  at=${word%"${word##*[=:]}"}
  COMPREPLY=("${COMPREPLY[@]#"$at"}")
  [[ ${COMPREPLY[0]} != *[/=] ]] || compopt -o nospace
  COMPREPLY=("${COMPREPLY[@]// /\\ }")
}
complete -F _freeplay freeplay
