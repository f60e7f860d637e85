"""Studies: many tests of one case with varied inputs."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _condyle, _html
from ._toml import document, value_text
from ._workers import Cluster, Source, run_on
from .case import Case
from .errors import BadInput
from .progress import StudyProgress, listening
from .search import Search
from .study_result import StudyResult

if TYPE_CHECKING:
    from concurrent.futures import Executor

__all__ = ["Study"]

TESTS_A_TASK = 64

# The path of a waveform whose processing a key changes.
_PROCESSED = re.compile(r"((?:machine|activity)\.[\w.-]+)\.(?:scale|offset|low_pass_harmonics)\b")


class Study:
    """Varied inputs of a case, a design of tests, and the requested answers, with the keys of a study file.

    >>> study = Study.from_dict({
    ...     "design": {"kind": "latin-hypercube", "size": 4},
    ...     "vary": [{"key": "contact.friction", "low": 0.03, "high": 0.1}],
    ... }, case=Case.from_text(""))
    >>> study.tests, study.inputs
    (4, ['contact.friction'])
    >>> 0.03 <= study.case(2)["contact.friction"] <= 0.1
    True
    """

    __slots__ = ("_raw", "_source")

    def __init__(self, path: str, text: str, files: Mapping[str, bytes] | None = None) -> None:
        """Use :meth:`read`, :meth:`from_text` or :meth:`from_dict`."""
        base, files = os.getcwd(), dict(files or {})
        self._raw = _condyle.RawStudy(path, text, base, files)
        self._source = Source(path, text, base, tuple(sorted(files.items())), self.inputs_blake3, _condyle.VERSION)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Study:
        """Reads the study file at ``path``; paths in it are relative to its folder.

        Raises:
            BadInput: all problems of the study and its case, with their places.
        """
        return cls(os.path.abspath(path), _condyle.RawCase.read_text(path))

    @classmethod
    def from_text(cls, text: str, *, folder: str | os.PathLike[str] = ".", case: Case | None = None) -> Study:
        """Reads a study from TOML text.

        Args:
            text: the text of a study file.
            folder: paths in it are relative to this folder.
            case: the case, if ``text`` names none; its bodies may be arrays. If :meth:`Case.replace` has changed it, keys
                such as ``scale`` of its scaled waveforms cannot be varied.

        Raises:
            BadInput: all problems of the study and its case, with their places.
        """
        path = os.path.join(os.path.abspath(folder), "study")
        if case is None:
            return cls(path, text)
        name, written = case.file
        study = cls(path, f"case = {value_text(name)}\n{text}", {**case.arrays, name: written.encode()})
        for waveform in set(_PROCESSED.findall("\n".join([text, *study.inputs]))):
            # The study would process the points again.
            if case.has_processed(waveform):
                raise BadInput(
                    f"the study varies the processing of {waveform}, which the case processes, and the case was changed by "
                    "replace; write the changed values into the file or text of the case"
                )
        return study

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], *, folder: str | os.PathLike[str] = ".", case: Case | None = None) -> Study:
        """Creates a study from nested dictionaries; ``vary``, ``alternative``, ``output``, ``limit`` and ``correlation`` are lists of them.

        Entries that are ``None`` are omitted; otherwise as :meth:`from_text`.
        """
        return cls.from_text(document(tables), folder=folder, case=case)

    @property
    def tests(self) -> int:
        """The number of tests; for a search the maximum."""
        return self._raw.tests

    @property
    def design(self) -> str:
        """The design of the tests, such as ``"latin-hypercube"``."""
        return self._raw.design

    @property
    def inputs(self) -> list[str]:
        """The dotted paths of the varied keys."""
        return self._raw.inputs

    @property
    def inputs_blake3(self) -> str:
        """The hash of all inputs of the tests: the case, its meshes, the varied keys, and the design."""
        return self._raw.inputs_blake3

    def case(self, row: int, out: str | os.PathLike[str] | None = None) -> Case:
        """The case of test ``row``, counted from 0; tests of a search are read from the study's folder ``out``."""
        if row < 0:
            raise BadInput(f"the study has no row {row}; rows count from 0")
        return self._changed(self._raw.changes(row, None if out is None else os.fspath(out)))

    def _changed(self, changes: Sequence[str]) -> Case:
        source = self._source
        path = os.fspath(self._raw.case_path)
        files = dict(source.files)
        text = files[path].decode() if path in files else _condyle.RawCase.read_text(path)
        return Case(path, text, source.base, files, tuple(changes))

    def run(
        self,
        out: str | os.PathLike[str],
        progress: bool | Callable[[StudyProgress], Any] | None = None,
        *,
        threads: int | None = None,
        executor: Executor | None = None,
        client: Any = None,
        tests_a_task: int = TESTS_A_TASK,
    ) -> StudyResult:
        """Runs every test that the folder ``out`` does not hold yet, and evaluates all of them.

        The table has the same bytes on any number of threads, processes and machines, and after any interruption.
        A failed test is a row with its reason, and the study continues.

        Args:
            out: a folder for the database, the table, the answers and their page, as ``condyle study`` writes them. A
                stopped or killed study resumes.
            progress: ``True`` for a bar, or a function that is called with a :class:`StudyProgress` as tests are stored.
                The study stops with :class:`StudyInterrupted` if it returns ``False`` or raises.
            threads: parallel tests in this process; by default as many as processors.
            executor: an executor of ``concurrent.futures``, or an object with the same ``submit``, that runs the tests
                instead. Its workers need condyle, and the files of study and case under the same paths.
            client: a ``dask.distributed.Client``, for the same purpose. A task is repeated if its worker dies; the study
                ends if the scheduler does not answer for 20 s.
            tests_a_task: tests that are sent to a worker at once.

        Raises:
            BadInput: a folder of another study or in use, or a search on an executor, since its tests depend on each other.
            StudyInterrupted: a listener that stops the study, or a scheduler that is lost; the stored tests are kept.
        """
        if executor is not None and client is not None:
            raise ValueError("give an executor or a client, not both")
        cluster = None
        if client is not None:
            executor, cluster = client.get_executor(pure=False), Cluster(client)
        with listening(progress) as listener:
            if executor is None:
                self._raw.run(out, threads or os.cpu_count() or 1, listener)
            else:
                run_on(executor, cluster, self._raw, self._source, os.fspath(out), tests_a_task, listener)
        return self.answered(out)

    def search(self, out: str | os.PathLike[str]) -> Search:
        """Opens the folder ``out`` for a search whose tests run elsewhere: the design's kind is ``optimise``.

        Raises:
            BadInput: a folder of another study or in use.
        """
        return Search(self, out)

    def merge(self, shards: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> StudyResult:
        """Merges the tests of several folders of this study, such as those of ``--shard``, into the folder ``out``."""
        self._raw.merge([os.fspath(shard) for shard in shards], out)
        return self.answered(out)

    def answered(self, out: str | os.PathLike[str]) -> StudyResult:
        """Evaluates the tests that the folder ``out`` holds so far; rewrites table, answers and page."""
        return StudyResult(Path(out), json.loads(self._raw.answers(out)))

    def __repr__(self) -> str:
        return f"<condyle.Study of {self.tests} tests, {self.design}: {', '.join(self.inputs)}>"

    def _repr_html_(self) -> str:
        return _html.table(f"Study of {self.tests} tests, {self.design}", ("input",), [[key] for key in self.inputs])

    def __reduce__(self) -> tuple[Any, ...]:
        return Study, (self._source.path, self._source.text, dict(self._source.files))
