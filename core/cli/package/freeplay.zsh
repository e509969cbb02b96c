#compdef freeplay
# Completion of freeplay in zsh: the program itself says how a line can go on.
local -a found
found=(${(f)"$($words[1] complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)"})
compadd -S '' -- ${(M)found:#*[/=]}
compadd -- ${found:#*[/=]}
