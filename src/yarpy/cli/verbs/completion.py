"""`yarpy completion bash|zsh|fish`: what makes Tab complete verbs, ports, carriers and files.

Put one of these lines where your shell reads it:

    eval "$(yarpy completion bash)"                          # ~/.bashrc
    eval "$(yarpy completion zsh)"                           # ~/.zshrc, behind compinit
    yarpy completion fish > ~/.config/fish/completions/yarpy.fish

Exit codes: 0.
"""

from __future__ import annotations

from typing import Final

import click

from yarpy.cli.completion import FILES, complete
from yarpy.cli.output import print_line

# Bash ends words at colons, and the names of ports are full of them: only what follows the last
# colon is handed back then.
BASH: Final = r"""_yarpy_complete() {
    local line="${COMP_LINE:0:COMP_POINT}" word head IFS=$'\n'
    word="${line##*[[:space:]]}"
    COMPREPLY=($(yarpy completion --line "$line" 2>/dev/null | cut -f 1))
    if [[ ${COMPREPLY[0]} == FILES ]]; then
        COMPREPLY=()
        compopt -o default
    elif [[ $word == *:* && $COMP_WORDBREAKS == *:* ]]; then
        head="${word%"${word##*:}"}"
        COMPREPLY=("${COMPREPLY[@]#"$head"}")
    fi
}
complete -F _yarpy_complete yarpy
"""
ZSH: Final = r"""#compdef yarpy
_yarpy_complete() {
    local -a lines values shown
    local line
    lines=("${(@f)$(yarpy completion --line "$LBUFFER" 2>/dev/null)}")
    if [[ ${lines[1]} == FILES ]]; then
        _files
        return
    fi
    for line in $lines; do
        values+=("${line%%$'\t'*}")
        shown+=("${line/$'\t'/  }")
    done
    compadd -l -d shown -a values
}
compdef _yarpy_complete yarpy
"""
FISH: Final = r"""function __yarpy_complete
    set -l found (yarpy completion --line (commandline -cp | string collect) 2>/dev/null)
    if test "$found[1]" = FILES
        __fish_complete_path (commandline -ct)
    else
        printf '%s\n' $found
    end
end
complete --command yarpy --no-files --arguments '(__yarpy_complete)'
"""
SCRIPTS: Final = {
    shell: script.replace("FILES", FILES)
    for shell, script in (("bash", BASH), ("zsh", ZSH), ("fish", FISH))
}


@click.command()
@click.argument("shell", type=click.Choice([*SCRIPTS]), required=False)
@click.option("--line", hidden=True, help="Print what may follow LINE instead.")
def command(shell: str | None, line: str | None) -> int:
    """Print the lines that make Tab complete `yarpy` in a shell."""
    if line is not None:
        for found in complete(line):
            print_line("\t".join(found).rstrip("\t"))
        return 0
    if shell is None:
        raise click.UsageError("name your shell: bash, zsh or fish")
    print_line(SCRIPTS[shell].rstrip("\n"))
    return 0
