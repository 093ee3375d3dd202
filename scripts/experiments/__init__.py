# SPDX-License-Identifier: BSD-3-Clause
"""Repeats the experiments of Wuethrich et al. (IROS 2013) in simulation; the command is scripts/paper_experiments."""
