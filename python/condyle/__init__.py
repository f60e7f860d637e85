"""condyle: virtual wear tests of knee replacements.

>>> import condyle
>>> result = condyle.run({"march": {"updates": 1}, "accuracy": {"estimate": False}})
>>> result.updates
1

Names of numbers end with their unit. The book lists the keys of a case; ``Case.text`` shows them all.
"""

from __future__ import annotations

from ._condyle import VERSION
from .answers import Answer, Answers
from .case import Case
from .check import Check
from .emulator import Emulator
from .errors import BadInput, CondyleError, Interrupted, NotSolved, Problem, StudyInterrupted
from .knee import Contact, Cycle, Knee
from .laws import NodeCycle
from .progress import Bar, Progress, StudyProgress
from .result import Result
from .run import open, run
from .search import Search
from .study import Study
from .study_result import StudyResult, open_study
from .table import Table

__version__ = VERSION

__all__ = [
    "Answer",
    "Answers",
    "BadInput",
    "Bar",
    "Case",
    "Check",
    "CondyleError",
    "Contact",
    "Cycle",
    "Emulator",
    "Interrupted",
    "Knee",
    "NodeCycle",
    "NotSolved",
    "Problem",
    "Progress",
    "Result",
    "Search",
    "Study",
    "StudyInterrupted",
    "StudyProgress",
    "StudyResult",
    "Table",
    "open",
    "open_study",
    "run",
]
