# SPDX-License-Identifier: BSD-3-Clause
"""ADD, ADD-S, translation and rotation error, and normalised estimation errors (NEES) of a pose."""
import numpy as np
from scipy.spatial import cKDTree

from .mesh_points import evenly_chosen
from .poses import difference
from .symmetries import constrained_basis, fold

MAX_QUERY_POINTS = 2000  # averaged over
MAX_INDEX_POINTS = 50000  # among which ADD-S looks for the nearest


class PoseErrorMeter:
    """Measures errors of one object. points: vertices (n x 3) [m]."""

    def __init__(self, points, symmetries):
        self.symmetries = symmetries
        self._points = evenly_chosen(points, MAX_QUERY_POINTS)
        self._index = cKDTree(evenly_chosen(points, MAX_INDEX_POINTS))

    @property
    def symmetric(self):
        return self.symmetries.any()

    def add(self, T_estimate, T_truth):
        """Mean distance of corresponding points [m]."""
        delta = T_estimate[:3] - T_truth[:3]
        return float(np.linalg.norm(self._points @ delta[:, :3].T + delta[:, 3], axis=1).mean())

    def add_s(self, T_estimate, T_truth):
        """Mean distance of the estimate's points to the nearest true point [m]."""
        R = T_truth[:3, :3].T @ T_estimate[:3, :3]
        t = T_truth[:3, :3].T @ (T_estimate[:3, 3] - T_truth[:3, 3])
        return float(self._index.query(self._points @ R.T + t)[0].mean())

    def error_vector(self, T_estimate, T_truth):
        """[t_truth - t_estimate; Log(R_truth R_estimate^T)] to the nearest equivalent of the truth."""
        return difference(fold(T_truth, T_estimate, self.symmetries), T_estimate)

    def nees(self, T_estimate, covariance, T_truth):
        """(e^T C^-1 e, degrees of freedom) with free directions of symmetries left out; NaN where C is not positive
        definite. covariance: 6x6 of [x y z rx ry rz], rotation applied from the left."""
        basis = constrained_basis(T_estimate, self.symmetries)
        e = basis.T @ self.error_vector(T_estimate, T_truth)
        dof = basis.shape[1]
        try:
            whitened = np.linalg.solve(np.linalg.cholesky(basis.T @ covariance @ basis), e)
        except np.linalg.LinAlgError:
            return float("nan"), dof
        return float(whitened @ whitened), dof

    def standard_deviations(self, T_estimate, covariance):
        """Predicted (translation [m], rotation [rad]): root of the traces without the free directions, which is what
        the norms of error_vector's halves are to be compared with."""
        basis = constrained_basis(T_estimate, self.symmetries)
        projected = basis @ basis.T @ covariance @ basis @ basis.T
        return tuple(float(np.sqrt(max(np.trace(block), 0.0))) for block in (projected[:3, :3], projected[3:, 3:]))
