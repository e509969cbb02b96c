# Completion of freeplay in fish: the program itself says how a line can go on.
complete -c freeplay -f -a '(set -l words (commandline -opc); $words[1] complete $words[2..] (commandline -ct) 2>/dev/null)'
