# Completion of gearstudy for bash: source <(gearstudy completions bash)
_gearstudy() {
    local words=() word i cut="" replies reply
    # Bash parts words at `=`; the program takes them whole, and is asked for what is left of the last.
    for ((i = 0; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if ((i == COMP_CWORD)) && [[ $word != "=" ]]; then word=$2; fi
        if ((i > 0)) && [[ $COMP_WORDBREAKS == *=* ]] && [[ $word == "=" || ${words[${#words[@]} - 1]} == *= && ${COMP_WORDS[i - 1]} == "=" ]]; then
            words[${#words[@]} - 1]+=$word
        else
            words+=("$word")
        fi
    done
    word=${words[${#words[@]} - 1]}
    if [[ $COMP_WORDBREAKS == *=* && $word == *=* ]]; then cut=${word%=*}=; fi
    replies=$(
        _CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((${#words[@]} - 1)) GEARSTUDY_COMPLETE=bash \
            PROGRAM -- "${words[@]}" 2>/dev/null
    ) || return
    COMPREPLY=()
    compopt +o nospace 2>/dev/null
    while IFS= read -r reply; do
        [[ -n $reply ]] || continue
        reply=${reply#"$cut"}
        if [[ $reply == *[[:space:]\;\&\(\)\<\>\|]* ]]; then printf -v reply %q "$reply"; fi
        COMPREPLY+=("$reply")
        if [[ $reply == *[=/.] ]]; then compopt -o nospace 2>/dev/null; fi
    done <<<"$replies"
}
complete -o nospace -o bashdefault -F _gearstudy gearstudy
