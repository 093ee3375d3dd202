# SPDX-License-Identifier: BSD-3-Clause
"""What the tracker says against the truth."""
import math
import unittest

from evaluation.state_confusion import add_tables, confusion, longest_run, right_share, true_state


class States(unittest.TestCase):
    def test_truth(self):
        self.assertEqual(true_state(0.001, 1.0), "TRACKING")
        self.assertEqual(true_state(0.2, 1.0), "LOST")
        self.assertEqual(true_state(0.2, 0.05), "OCCLUDED")
        self.assertEqual(true_state(0.2, math.nan), "LOST")  # nobody says that it is hidden
        self.assertIsNone(true_state(math.nan, 1.0))

    def test_table(self):
        table = confusion([0.0, 0.0, 0.2, 0.2, math.nan], [1.0, 0.0, 1.0, 1.0, 1.0],
                          ["TRACKING", "OCCLUDED", "TRACKING", "LOST", "LOST"])
        self.assertEqual(table["TRACKING"]["TRACKING"], 1)
        self.assertEqual(table["OCCLUDED"]["OCCLUDED"], 1)
        self.assertEqual(table["LOST"]["TRACKING"], 1)
        self.assertEqual(table["LOST"]["LOST"], 1)
        self.assertEqual(right_share(table, "LOST"), 0.5)
        self.assertEqual(add_tables([table, table])["LOST"]["LOST"], 2)

    def test_share_of_no_frames(self):
        self.assertTrue(math.isnan(right_share(confusion([], [], []), "LOST")))

    def test_longest_run(self):
        errors, visible = [0.2] * 6, [1.0] * 6
        states = ["TRACKING", "TRACKING", "LOST", "TRACKING", "TRACKING", "TRACKING"]
        self.assertEqual(longest_run(errors, visible, states, "LOST", "TRACKING"), 3)


if __name__ == "__main__":
    unittest.main()
