# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m stiv.command_line`: the command where no script was installed."""

from stiv.command_line.program import main

main()
