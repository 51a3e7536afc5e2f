# `drypoint man` prints the pages of the command and of its subcommands in a row. Writes each to a file of its own in `folder`.
# Each page begins with definitions of quotation marks, before its title.
/^\.(ie|el) .*ds Aq / {
    definitions = definitions $0 "\n"
    next
}
/^\.TH / {
    close(page)
    page = folder "/" $2 ".1"
    printf "%s", definitions > page
    definitions = ""
    # Only the first title has the version.
    sub(/"[^"]*" *$/, "\"" version "\"")
}
{ print > page }
