# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the energies of solutions: how close to their goals they end."""

from __future__ import annotations

from benchmarks.results_tables.markdown import SCENES, loaded, markdown


def settled() -> str:
    """Energies of solutions settled until nothing changes."""
    lines = [
        [
            scene["scene"],
            str(scene["edits"]),
            *(f"{value:.2f}" for value in scene["energies"].values()),
            str(scene["paper_nearer"]),
        ]
        for scene in sorted(loaded("settled_edits"), key=lambda scene: SCENES.index(scene["scene"]))
    ]
    head = ["scene", "edits", "ours", "ours, settled", "paper", "paper, settled", "best of each", "paper closer in"]
    return markdown(head, lines)


def whole_drags() -> str:
    """Energies of whole drags relative to a stop at the first contact."""
    content = loaded("whole_drags")
    order = sorted(content["drags"], key=lambda drag: SCENES.index(drag["scene"]))
    lines = [
        [
            f"{drag['scene']}: {drag['stage'].replace('_', ' ')}",
            f"{100 * drag['step']:.0f} %",
            f"{drag['contacts']:.0f}",
            *(f"{value:.3f}" for value in drag["energies"].values()),
        ]
        for drag in order
    ]
    lines.append(["geometric mean", "", "", *(f"{value:.3f}" for value in content["means"].values())])
    return markdown(["drag", "step", "contacts per round", *content["means"]], lines)


def fourteen() -> str:
    """Energies of the fourteen edits relative to a stop at the first contact."""
    content = loaded("paper_preset")
    lines = []
    for edit in content["edits"]:
        energies = [edit["ours"]["energy"], edit["settled"], *(answer["energy"] for answer in edit["paper"].values())]
        least = "" if edit["converged"] is None else f"{edit['converged'] / edit['stopped']:.4f}"
        if least and not edit["converged_in_time"]:
            least += " (time over)"
        lines.append([edit["edit"], *(f"{energy / edit['stopped']:.4f}" for energy in energies), least])
    lines.append(["geometric mean", *(f"{value:.4f}" for value in content["means"].values()), ""])
    return markdown(["edit", *content["means"], "interior point"], lines)
