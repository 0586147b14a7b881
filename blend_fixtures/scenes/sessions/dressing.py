# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 1: an ogre is dressed in a shirt that cuts it, and in glasses and a hat that are too narrow; all
Loop surfaces.

The body is contracted until the shirt no longer cuts it, and expanded again without intersections. The shirt
is shrunk onto it. Glasses and hat move rigidly to the head and are then pressed on with their cages, so they
widen.
"""

from __future__ import annotations

import numpy as np

import stiv

from ..colors import CLOTH, FELT, HORN, SKIN
from ..fixture import Fixture, MeshObject, VertexGroup, View
from ..motion import contract, expand, move, on_objects, on_points, scale
from ..ogre import glasses, hat, ogre, shirt
from ..shape import Shape
from .session import Array, Edit, Session, Stages, moved, repeated, scaled
from .subdivision_parts import Parts, part

LEVELS = {"Ogre": 2, "Shirt": 2, "Glasses": 1, "Hat": 2}
EXPANSIONS, SHRINKS, APPROACHES, PRESSES = 24, 20, 16, 16
CONTRACTIONS = 12
BODY_WEIGHT = 0.05  # response weight of the shirt during the expansion
SHRINK = 0.985
WORN = {"Glasses": np.array([0, 0.55, 0]), "Hat": np.array([0, 0, -0.36])}  # and the way there
PRESSED = 0.45  # of that way


def cages() -> dict[str, Shape]:
    """The modeled cages."""
    return {"Ogre": ogre(), "Shirt": shirt(), "Glasses": glasses(), "Hat": hat()}


def parts() -> Parts:
    """Their surfaces: 13,318 vertices and 26,060 triangles in the paper, equal within 1 %."""
    return Parts({name: part(cage, LEVELS[name]) for name, cage in cages().items()})


def contract_body(scene: Parts) -> None:
    """Contract the cage of the ogre stepwise until it no longer intersects the shirt in the exact test."""
    body = scene.parts["Ogre"].cage
    start, smoothing = body.vertices, 1.0
    for _ in range(CONTRACTIONS):
        if scene.pairs(("Ogre", "Shirt")) == 0:
            return
        step = stiv.contraction_step(body.triangles(), scene.cages["Ogre"], start=start, smoothing=smoothing)
        scene.cages["Ogre"] = step.astype(np.float32).astype(float)
        smoothing *= 2
    raise RuntimeError("the body cannot be contracted out of the shirt")


def expansions(first: Array, last: Array, block: Array) -> tuple[Edit, ...]:
    """Edits that move the controls of `block` from `first` to `last` in even steps, wherever they were stopped."""

    def toward(share: float) -> Edit:
        def goal(controls: Array) -> Array:
            result = controls.copy()
            result[block] = first + share * (last - first)
            return result

        return goal

    return tuple(toward((k + 1) / EXPANSIONS) for k in range(EXPANSIONS))


def stages(scene: Parts) -> Stages:
    """The session from the contracted body to the hat, for any parts with these names."""
    full = scene.cages["Ogre"]
    contract_body(scene)

    both = ("Ogre", "Shirt")
    edits = expansions(scene.cages["Ogre"], full, scene.block(both, "Ogre"))
    controls = yield scene.by_cages("expand", both, edits, {"Ogre": BODY_WEIGHT, "Shirt": 1.0})
    scene.take_cages(both, controls)

    shrink = scaled(SHRINK)
    controls = yield scene.by_cages("shrink", ("Shirt",), repeated(shrink, SHRINKS))
    scene.take_cages(("Shirt",), controls)

    for worn, toward in WORN.items():
        approach = moved(toward / APPROACHES, np.array([0]))
        controls = yield scene.rigidly(f"{worn.lower()}, rigid", worn, repeated(approach, APPROACHES))
        scene.take_rigid(worn, controls)
        press = moved(PRESSED * toward / PRESSES)
        controls = yield scene.by_cages(f"{worn.lower()}, pressed", (worn,), repeated(press, PRESSES))
        scene.take_cages((worn,), controls)


def session() -> Session:
    """The whole dressing."""
    return Session(
        "dressing", 1, "An ogre is dressed with a shirt, glasses and a hat made for others", lambda: stages(parts())
    )


def dressing() -> Fixture:
    """The same session in Blender, starting with the shirt that cuts the body."""
    shapes, colors = cages(), {"Ogre": SKIN, "Shirt": CLOTH, "Glasses": HORN, "Hat": FELT}
    stiff = VertexGroup("Gives way", dict.fromkeys(range(len(shapes["Ogre"].vertices)), BODY_WEIGHT))
    groups = {"Ogre": (stiff,)}
    meshes = (
        MeshObject(name, shape, colors[name], loop=LEVELS[name], groups=groups.get(name, ()))
        for name, shape in shapes.items()
    )
    both, shrunk = on_objects(["Ogre", "Shirt"]), (SHRINK, SHRINK, SHRINK)
    steps = [contract(on_objects(["Ogre"]), CONTRACTIONS)]
    steps += expand(both, [(k + 1) / EXPANSIONS for k in range(EXPANSIONS)])
    steps.append(scale(on_points("Shirt"), shrunk, repeat=SHRINKS))
    for worn, toward in WORN.items():
        steps.append(move(on_objects([worn]), (toward / APPROACHES).tolist(), repeat=APPROACHES))
        steps.append(move(on_points(worn), (PRESSED * toward / PRESSES).tolist(), repeat=PRESSES))
    return Fixture(
        name="dressing",
        summary="An ogre is dressed: contracted out of a shirt that cuts it, expanded; the shirt shrunk onto it, "
        "glasses and a hat put on and pressed on",
        meshes=tuple(meshes),
        steps=tuple(steps),
        view=View((2.6, -5.4, 1.9), (0.0, 0.0, 1.22), 62.0),
        settings={"object_response": "slide_and_turn", "objects": {"Ogre": {"weight_group": "Gives way"}}},
    )
