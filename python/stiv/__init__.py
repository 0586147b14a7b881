# SPDX-License-Identifier: GPL-3.0-or-later
"""Interference-aware geometric modeling: surfaces that do not go through each other."""

from stiv._native import InputError, StartIntersectsError
from stiv.contraction import (
    ContractionOptions,
    ContractionResult,
    contract,
    contraction_step,
    expand,
    start_contract,
    start_contraction_step,
    start_expand,
)
from stiv.deformation import (
    Deformation,
    compose,
    concatenate,
    identity,
    linear,
    linear_weights,
    rigid,
    rigid_rest_controls,
    scaling,
    scaling_rest_controls,
)
from stiv.detection import Detector, Events, find_interference, time_of_impact
from stiv.distances import LeastDistance, least_distance
from stiv.edit_session import CancelToken, EditOptions, EditResult, EditSession, StorageFrame, edit
from stiv.handles import arap, laplacian, stored_mesh
from stiv.intersections import (
    DeviationTest,
    IntersectionTest,
    StepCheck,
    find_intersections,
    find_loose_intersections,
    intersection_depths,
    is_step_free,
)
from stiv.job import CancelledError, Job, JobProgress
from stiv.lattices import lattice, lattice_rest_points, lattice_weights
from stiv.observed import InfeasibleError, ObservedDeformation, observed
from stiv.obstacles import Obstacle
from stiv.paper_preset import PAPER_DIFFERENCES
from stiv.repairing import RepairOptions, RepairResult, repair, start_repair
from stiv.scalars import ScalarDeformation, difference_jacobian, scalars
from stiv.self_test import SelfTest, self_test
from stiv.subdivision import Cage, catmull_clark, loop, subdivided_faces, subdivision_weights
from stiv.surface import Body, Surface
from stiv.weights import Weights
from stiv.welding import Welded, join_seams, weld

__all__ = [
    "PAPER_DIFFERENCES",
    "Body",
    "Cage",
    "CancelToken",
    "CancelledError",
    "ContractionOptions",
    "ContractionResult",
    "Deformation",
    "Detector",
    "DeviationTest",
    "EditOptions",
    "EditResult",
    "EditSession",
    "Events",
    "InfeasibleError",
    "InputError",
    "IntersectionTest",
    "Job",
    "JobProgress",
    "LeastDistance",
    "ObservedDeformation",
    "Obstacle",
    "RepairOptions",
    "RepairResult",
    "ScalarDeformation",
    "SelfTest",
    "StartIntersectsError",
    "StepCheck",
    "StorageFrame",
    "Surface",
    "Weights",
    "Welded",
    "arap",
    "catmull_clark",
    "compose",
    "concatenate",
    "contract",
    "contraction_step",
    "difference_jacobian",
    "edit",
    "expand",
    "find_interference",
    "find_intersections",
    "find_loose_intersections",
    "identity",
    "intersection_depths",
    "is_step_free",
    "join_seams",
    "laplacian",
    "lattice",
    "lattice_rest_points",
    "lattice_weights",
    "least_distance",
    "linear",
    "linear_weights",
    "loop",
    "observed",
    "repair",
    "rigid",
    "rigid_rest_controls",
    "scalars",
    "scaling",
    "scaling_rest_controls",
    "self_test",
    "start_contract",
    "start_contraction_step",
    "start_expand",
    "start_repair",
    "stored_mesh",
    "subdivided_faces",
    "subdivision_weights",
    "time_of_impact",
    "weld",
]
