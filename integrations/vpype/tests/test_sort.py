"""`vpype dpsort` travels less than `linesort`, and every stroke is there once, as it was."""

import sys
import unittest

import numpy as np
import vpype
from pipeline import HOPPER, MM, SMALL, directed, document_of, pipeline, travel_mm, undirected


def strokes(count: int) -> list[np.ndarray]:
    """Short strokes all over an A4 sheet."""
    numbers = np.random.default_rng(7)
    begin = numbers.random(count) * 200 + 1j * numbers.random(count) * 280
    way = numbers.normal(size=count) * 2 + 1j * numbers.normal(size=count) * 2
    return list(np.column_stack([begin, begin + way]) * MM)


def loops(count: int) -> list[np.ndarray]:
    """Circles, begun anywhere."""
    numbers = np.random.default_rng(8)
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 41))
    found = []
    for _ in range(count):
        circle = complex(*numbers.random(2) * 200) + (1 + 4 * numbers.random()) * turn * np.exp(6j * numbers.random())
        circle[-1] = circle[0]
        found.append(circle * MM)
    return found


# Repeated, without length, of one place, there and back, beyond the page, closed to a hair.
ODD = [
    np.array(line, complex) * MM
    for line in [
        [5 + 5j, 9 + 9j],
        [5 + 5j, 9 + 9j],
        [9 + 9j, 5 + 5j],
        [4 + 4j, 4 + 4j],
        [4 + 4j, 4 + 4j, 4 + 4j],
        [1, 2, 1],
        [1, 2, 1, 2],
        [7, 7.0001, 7],
        [-50 - 20j, 30],
        [0, 10, 10 + 10j, 10j, 0],
        [10, 10 + 10j, 10j, 0, 10],
        [0, 10, 10 + 10j, 10j, 0],
        [0, 10, 10 + 10j, 10j, 1e-4],
        [20, 30, 30 + 10j, 20, 10 + 10j, 10, 20],
        [900 + 900j, 901 + 900j],
    ]
]


class Sort(unittest.TestCase):
    def check_shorter(self, name: str, words: str, document: vpype.Document) -> None:
        """dpsort against linesort with the same liberties."""
        ours = travel_mm(pipeline(f"dpsort {words}", document))
        theirs = travel_mm(pipeline(f"linesort {'--no-flip' if 'keep-direction' in words else ''}", document))
        print(f"{name} {words}: {ours:.0f} mm of travel, linesort {theirs:.0f} mm", file=sys.stderr)
        self.assertLess(ours, theirs)

    def check_complete(self, before: list[np.ndarray], after: vpype.LineCollection) -> None:
        """Open lines as they were or reversed; closed ones with the same line, and at most one point more."""
        self.assertEqual(len(after), len(before))
        is_open = [line for line in before if line[0] != line[-1]]
        self.assertEqual(undirected(line for line in after if line[0] != line[-1]), undirected(is_open))
        lengths = [sorted(np.abs(np.diff(line)).sum() for line in lines) for lines in (before, after)]
        np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-9, atol=1e-9)
        self.assertLessEqual(sum(map(len, after)), sum(map(len, before)) + len(before) - len(is_open))
        points = [set(np.concatenate(list(lines)).tolist()) for lines in (before, after)]
        self.assertLessEqual(points[0], points[1])

    def test_random_strokes(self) -> None:
        lines = strokes(5000)
        document = document_of(lines)
        self.check_shorter("5000 strokes", "", document)
        self.check_shorter("5000 strokes", "--fast", document)
        self.check_complete(lines, pipeline("dpsort", document).layers[1])

    def test_directions_stay(self) -> None:
        lines = strokes(2000)
        document = document_of(lines)
        self.check_shorter("2000 strokes", "--keep-direction", document)
        self.assertEqual(directed(pipeline("dpsort --keep-direction", document).layers[1]), directed(lines))

    def test_loops(self) -> None:
        lines = loops(600) + strokes(200)
        document = document_of(lines)
        self.check_shorter("600 loops", "", document)
        self.check_shorter("600 loops", "--keep-seam", document)
        self.check_complete(lines, pipeline("dpsort", document).layers[1])
        self.assertEqual(undirected(pipeline("dpsort --keep-seam", document).layers[1]), undirected(lines))
        self.assertLess(travel_mm(pipeline("dpsort", document)), travel_mm(pipeline("dpsort --keep-seam", document)))

    def test_odd_lines(self) -> None:
        for words in ["", "--fast", "--keep-seam", "--keep-direction", "--keep-seam --keep-direction"]:
            with self.subTest(words=words):
                self.check_complete(ODD, pipeline(f"dpsort {words}", document_of(ODD)).layers[1])

    def test_a_drawing_of_a_sample(self) -> None:
        drawn = pipeline(f"drypoint {HOPPER} {SMALL}").layers[1]
        # It comes in order.
        lines = [drawn[i] for i in np.random.default_rng(9).permutation(len(drawn))]
        document = vpype.Document(drawn.clone(lines))
        document.layers[1].metadata = drawn.metadata
        self.check_shorter("hedcut", "", document)
        after = pipeline("dpsort", document).layers[1]
        self.check_complete(lines, after)
        self.assertEqual(after.metadata, drawn.metadata)

    def test_layers_stay_apart(self) -> None:
        document = document_of(strokes(300))
        document.add(strokes(200), 2)
        document.layers[2].set_property("vp_pen_width", 3.0)
        document.page_size = (500.0, 600.0)
        both, second = pipeline("dpsort", document), pipeline("dpsort --layer 2", document)
        for layer in (1, 2):
            self.assertEqual(undirected(both.layers[layer]), undirected(document.layers[layer]))
        self.assertEqual(second.layers[1], document.layers[1])
        self.assertEqual(second.layers[2], both.layers[2])
        self.assertEqual((both.layers[2].property("vp_pen_width"), both.page_size), (3.0, (500.0, 600.0)))

    def test_the_same_order_again(self) -> None:
        document = document_of(strokes(1000))
        one = pipeline("dpsort", document)
        self.assertEqual(one, pipeline("dpsort", document))
        self.assertLessEqual(travel_mm(pipeline("dpsort", one)), travel_mm(one))

    def test_few_lines(self) -> None:
        for lines in [[], strokes(1), strokes(2)]:
            self.assertEqual(len(pipeline("dpsort", document_of(lines)).layers.get(1, [])), len(lines))


if __name__ == "__main__":
    unittest.main()
