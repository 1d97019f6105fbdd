"""What is drawn: with matplotlib where that is installed, and for notebooks without it."""

import importlib.util
import pathlib
import unittest
import xml.etree.ElementTree

import softland

GOLD = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "mem-gold.toml"


class Plots(unittest.TestCase):
    def test_a_notebook_shows_the_chart_of_the_report_and_the_figures(self):
        closing = softland.load(GOLD).simulate()
        page = closing._repr_html_()
        chart = page[page.index("<svg") : page.index("</svg>") + len("</svg>")]
        xml.etree.ElementTree.fromstring(chart)
        self.assertIn(chart[chart.index("\n") :], closing.result().file("gap.svg"))
        self.assertIn("impact_velocity", page)

    @unittest.skipIf(importlib.util.find_spec("matplotlib") is None, "no matplotlib; needs: python3-matplotlib")
    def test_gap_and_drive_are_drawn(self):
        closing = softland.load(GOLD).simulate()
        above, below = closing.plot().axes
        self.assertEqual(len(above.lines[0].get_xdata()), len(closing.trajectory))
        self.assertEqual(below.lines[0].get_label(), "main")
        self.assertAlmostEqual(above.lines[1].get_ydata()[0], 0)
        self.assertEqual(len(softland.load(GOLD).modes().plot().lines), 4)
        self.assertEqual(len(softland.load(GOLD).waveforms["main"].plot("10 us").lines), 1)


if __name__ == "__main__":
    unittest.main()
