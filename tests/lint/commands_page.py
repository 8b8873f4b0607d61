#!/usr/bin/env python3
"""docs/COMMANDS.md is what the program's --help says: commands_page.py PROGRAM [--write]. Exit code 1 if it is not."""

import collections
import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "COMMANDS.md"
INTRODUCTION = """# Commands

Which options does each command have, and what do they do? This page is what `trichrome COMMAND --help` says, sorted.
It is generated: `tests/lint/commands_page.py build/dev/trichrome --write` writes it anew, and a test fails when it is stale.
Each setting says whether it biases the picture, that is, whether it moves the mean that endless rendering would reach.
A value in parentheses is the default.
"""
Option = collections.namedtuple("Option", "group name values text")


def help_of(program, *command):
    """The lines of --help."""
    run = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True)
    return run.stdout.split("\n")


def options_of(lines):
    """The options of a help text: a line with two spaces names one, lines with six describe it."""
    options, group = [], ""
    for line in lines:
        if re.fullmatch(r"\w[\w ]*:", line):
            group = line[:-1]
        elif re.match(r"  \S", line):
            name, _, values = line.strip().partition("  " if "  " in line.strip() else " ")
            options.append(Option(group.replace("Options", "General"), name.strip(), values.strip(), ""))
        elif line.startswith("      ") and options:
            last = options[-1]
            options[-1] = last._replace(text=(last.text + " " + line.strip()).strip())
    return [o for o in options if o.name != "-h,--help"]


def item(option):
    name = ", ".join(f"`{part}`" for part in option.name.split(","))
    return re.sub(r"(?<!`)([<>*_|])", r"\\\1", f"- {name} {option.values}".rstrip() + f"\n  {option.text}\n")


def page(program):
    top = help_of(program)
    commands = [line.split()[0] for line in top[top.index("Subcommands:") + 1 :] if line.startswith("  ")]
    helps = {c: help_of(program, c) for c in commands}
    options = {c: options_of(helps[c]) for c in commands}
    owners = collections.defaultdict(list)  # what is said alike by several commands is said once
    for command in commands:
        for option in options[command]:
            owners[option.name, option.text].append((command, option))
    shared = {key: pairs for key, pairs in owners.items() if len(pairs) > 1 and key[0] != "SCENE"}

    text = INTRODUCTION
    for command in commands:
        doc, usage = helps[command][:2]
        text += f"\n## trichrome {command}\n\n{doc}\n\n```\n{usage.removeprefix('Usage: ')}\n```\n\n"
        mine = [o for o in options[command] if (o.name, o.text) not in shared]
        text += "".join(item(o) for o in mine)
        common = [o for o in options[command] if (o.name, o.text) in shared]
        if common:
            groups = dict.fromkeys(o.group for o in common)
            text += f"\nBesides, shared options from [below](#shared-options): {', '.join(groups)}.\n"
        other = [o for o in common if o.values != shared[o.name, o.text][0][1].values]
        if other:
            defaults = [f"`{o.name}` {o.values.rsplit('(')[-1].removesuffix(')')}" for o in other]
            text += f"Other defaults here: {', '.join(defaults)}.\n"
        epilog = [line for line in helps[command][-3:] if line and not line.startswith(" ")]
        if epilog:
            text += "\n" + " ".join(epilog) + "\n"
    text += "\n## Shared options\n"
    for group in dict.fromkeys(pairs[0][1].group for pairs in shared.values()):
        text += f"\n### {group}\n\n"
        for pairs in shared.values():
            if pairs[0][1].group == group:
                users = "" if group == "Settings" else f" ({', '.join(command for command, _ in pairs)})"
                text += item(pairs[0][1]).removesuffix("\n") + users + "\n"
    return text


def main():
    wanted = page(sys.argv[1])
    if "--write" in sys.argv:
        PAGE.write_text(wanted, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != wanted:
        sys.exit(f"docs/COMMANDS.md is not what --help says; write it anew: {sys.argv[0]} {sys.argv[1]} --write")
    print(f"{PAGE} is what the program says")


if __name__ == "__main__":
    main()
