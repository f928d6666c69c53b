"""Tables and lines: what each says about an axis, and a table that is replayed at its own times."""

import asyncio
import math
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import settings as settings_of_hypothesis
from hypothesis import strategies as st

from derive.controller.channels import Channel
from derive.controller.feed import Feed
from derive.controller.reading import Reading, Unusable, judged
from derive.controller.refusal import Refused
from derive.controller.sources.lines import Input, Reader
from derive.controller.sources.pace import Pace
from derive.controller.sources.table import Recording, Replay, recording_of
from tests.controller.pages import GANTRY, message_where, page_of, served, settings

XY = (Channel("X", "X"), Channel("Y", "pos_y", 0.001))


@settings_of_hypothesis(max_examples=60)
@given(st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(), st.lists(st.floats())), st.floats())
def test_a_reading_is_a_finite_number_or_has_a_reason(raw: object, scale: float) -> None:
    """Whatever a controller answers, and whatever the scale is."""
    found = judged(raw, scale, 1.0)
    if found.value is None:
        assert found.reason
    else:
        assert isinstance(raw, int | float) and not isinstance(raw, bool)
        assert math.isfinite(found.value) and found == Reading(raw * scale, "", 1.0)


def written(folder: Path, text: str) -> Path:
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "text",
    [
        "time,X,pos_y\n0,1.5,-2\n0.5,2,3e3\n",
        "\ufefft;pos_y;x;more\r\n0;-2;1,5;a\r\n0,5;3000,0;2;b\r\n",
        "X\tpos_y\tTime\n1.5\t-2\t0\n2\t3000\t0.5\n\n",
    ],
)
def test_tables_of_all_kinds(text: str, tmp_path: Path) -> None:
    """Commas, semicolons with decimal commas, tabs; columns in any order; other columns are left out."""
    found = recording_of(written(tmp_path, text), XY, None)
    assert found.times == (0.0, 0.5) and found.rows == ({"X": 1.5, "Y": -2.0}, {"X": 2.0, "Y": 3000.0})


def test_a_table_without_headings_and_with_holes(tmp_path: Path) -> None:
    """Columns by their numbers; the time in milliseconds; a cell that is empty, missing or no number is unusable."""
    path = written(tmp_path, "1000,5,6\n1500,,7\n2000,8\n2500,x,nan\n")
    channels = Channel("X", "2"), Channel("Y", "3")
    found = recording_of(path, channels, Channel("time", "1", 0.001))
    assert found.times == (1.0, 1.5, 2.0, 2.5)
    assert found.rows[0] == {"X": 5.0, "Y": 6.0} and found.rows[1] == {"X": Unusable("no number: ''"), "Y": 7.0}
    assert found.rows[2]["Y"] == Unusable("no number: ''") and found.rows[3]["X"] == Unusable("no number: 'x'")
    assert math.isnan(found.rows[3]["Y"])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "there is no row of values"),
        ("time,X,pos_y\n", "there is no row of values"),
        ("time,Y,pos_y\n0,1,2\n", "there is no column 'X': the columns are time, Y, pos_y"),
        ("time,X,pos_y\n0,1,2\n1,1,2\n0.5,1,2\n", "row 4: the time is no number, or less than the one before"),
        ("time,X,pos_y\nnan,1,2\n", "row 2: the time is no number"),
        ("time,X,pos_y\n,1,2\n", "row 2: the time is no number"),
    ],
)
def test_a_wrong_table_is_refused_with_its_row(text: str, said: str, tmp_path: Path) -> None:
    """Before anything is served."""
    with pytest.raises(Refused) as problem:
        recording_of(written(tmp_path, text), XY, None)
    assert said in str(problem.value) and "table.csv" in str(problem.value)


def test_no_table() -> None:
    """Its name, and why."""
    with pytest.raises(Refused, match=r"none\.csv: No such file"):
        recording_of(Path("none.csv"), XY, None)


class Taken(Feed):
    """A feed that keeps all that it takes, with the time."""

    def __init__(self) -> None:
        super().__init__(XY)
        self.all: list[tuple[float, dict[str, object], float | None]] = []

    def take(self, answers: dict[str, object], recorded: float | None = None) -> None:  # type: ignore[override]
        """Keep."""
        super().take(answers, recorded)
        self.all.append((self.clock(), answers, recorded))


def test_a_replay_keeps_time() -> None:
    """Every row in order at its time divided by the speed, not before; the times need not start at 0."""
    times = (5.0, 5.2, 5.3, 5.9)
    recording = Recording(times, tuple({"X": t, "Y": 0.0} for t in times))
    feed = Taken()
    asyncio.run(Replay(recording, 2.0, False, 50.0).run(feed))
    assert [recorded for _, _, recorded in feed.all] == list(times)
    for at, answers, recorded in feed.all:
        assert recorded is not None and answers["X"] == recorded
        assert -0.001 <= (at - feed.all[0][0]) - (recorded - 5.0) / 2.0 < 1.0


def test_a_replay_that_is_too_fast_leaves_rows_out() -> None:
    """A thousand rows in 0.1 s: some of them, in order, the last one too; and in a loop again from the first."""
    times = tuple(i * 0.001 for i in range(1001))
    recording = Recording(times, tuple({"X": t, "Y": 0.0} for t in times))
    feed = Taken()
    asyncio.run(Replay(recording, 10.0, False, 50.0).run(feed))
    seen = [recorded for _, _, recorded in feed.all]
    assert seen[0] == 0.0 and seen[-1] == 1.0 and seen == sorted(seen) and 3 <= len(seen) <= 60  # type: ignore[type-var]

    async def loop() -> None:
        again = Taken()
        running = asyncio.create_task(Replay(recording, 50.0, True, 50.0).run(again))
        while sum(recorded == 0.0 for _, _, recorded in again.all) < 3:
            await asyncio.sleep(0.01)
        running.cancel()

    asyncio.run(asyncio.wait_for(loop(), 15))


@pytest.mark.parametrize(
    ("lines", "answers"),
    [
        (("1.5,2000",), {"X": 1.5, "Y": 2000.0}),
        (("[1.5, 2000]",), {"X": 1.5, "Y": 2000}),
        (('{"pos_y": 2000, "X": 1.5, "more": "a"}',), {"X": 1.5, "Y": 2000}),
        (('{"pos_y": 2000}',), {"Y": 2000}),
        (("pos_y, time, X", "2000, 0, 1.5"), {"X": 1.5, "Y": 2000.0}),
        (("pos_y,X", "[1, 2]"), {"X": 1, "Y": 2}),
        (("",), {}),
        (("X,pos_y",), {}),
        (("1,x",), {"X": 1.0, "Y": Unusable("no number: 'x'")}),
    ],
)
def test_lines(lines: tuple[str, ...], answers: dict[str, object]) -> None:
    """Values in the order of the axes, or of a first line of names; JSON by names, or in the order of the axes."""
    reader = Reader(XY)
    assert [reader.answers(line) for line in lines][-1] == answers


@pytest.mark.parametrize("line", ["{", "[1", "[1,2,3]", "1", "1,2,3", "[" * 100000])
def test_a_line_that_cannot_be_read_is_bad_for_every_axis(line: str) -> None:
    """And the next one is read as ever."""
    reader = Reader(XY)
    assert all(isinstance(said, Unusable) for said in reader.answers(line).values()) and reader.answers(line)
    assert reader.answers("1,2") == {"X": 1.0, "Y": 2.0}


@given(st.text())
def test_no_line_stops_the_reader(line: str) -> None:
    """Any text gives answers about axes, which may be none."""
    assert set(Reader(XY).answers(line)) <= {"X", "Y"}


async def test_input_arrives_and_ends(tmp_path: Path) -> None:
    """Lines in pieces, one that is too long, and one without an end; then the input is over."""
    told = settings(tmp_path, {**GANTRY, "source": "-"})
    reading, writing = os.pipe()
    async with served(told, source=Input(told.channels, reading)) as running, page_of(running) as page:
        os.write(writing, b"1,2\n3,")
        assert (await message_where(page, lambda m: m["complete"]))["axes"] == [1.0, 2.0]
        os.write(writing, b"4\n")
        await message_where(page, lambda m: m["axes"] == [3.0, 4.0])
        long = asyncio.create_task(asyncio.to_thread(os.write, writing, b"5" * 200_000 + b"\n"))
        bad = await message_where(page, lambda m: not m["complete"])
        assert bad["axes"] == [None, None]
        await long
        os.write(writing, b'{"X": NaN, "Y": 1}\n')
        await message_where(page, lambda m: m["reasons"][0] == "not finite: nan")
        os.write(writing, b"6,7")
        os.close(writing)
        over = await message_where(page, lambda m: m["status"] == "ended")
        assert over["axes"] == [6.0, 7.0]
    os.close(reading)


def test_the_end_of_a_line_that_is_too_long_is_no_line() -> None:
    """A machine of one axis must not go to 5, which is all that was kept of it."""
    reading, writing = os.pipe()
    feed = Taken()
    filled = [b" " * 70_000 + b"5\n", b"7\n", b" " * 200_000 + b"5\n", b" " * 65_000 + b"8\n", b" " * 70_000 + b"5"]

    def fill() -> None:
        for line in filled:
            os.write(writing, line)
        os.close(writing)

    async def run() -> None:
        await asyncio.gather(Input(XY[:1], reading).run(feed), asyncio.to_thread(fill))

    asyncio.run(asyncio.wait_for(run(), 15))
    os.close(reading)
    seen = [answers["X"] for _, answers, _ in feed.all]
    assert [isinstance(value, Unusable) for value in seen] == [True, False, True, False, True] and seen[1::2] == [
        7.0,
        8.0,
    ]


async def test_a_pace_does_not_hurry_to_catch_up() -> None:
    """Moments at equal distances; after a pause the next one is at once, and then one at a time again."""
    clock = asyncio.get_running_loop().time
    pace, start = Pace(100.0), clock()
    for _ in range(10):
        await pace.next()
    assert clock() - start >= 0.099
    await asyncio.sleep(0.1)
    await pace.next()
    late = clock()
    for _ in range(3):
        await pace.next()
    assert clock() - late >= 0.029
