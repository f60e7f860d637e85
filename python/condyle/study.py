"""Studies: a case run again and again with what varies of it."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _condyle
from ._toml import document, value_text
from ._workers import Source, run_on
from .case import Case
from .progress import Bar, StudyProgress
from .study_result import StudyResult

if TYPE_CHECKING:
    from concurrent.futures import Executor

__all__ = ["Study"]

TESTS_A_TASK = 64


class Study:
    """What varies of a case, which tests are done, and what is asked of them; the keys are those of a study file.

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
        """Reads the study file at ``path``; paths in it count from its folder.

        Raises:
            BadInput: with everything that is wrong with it or with its case, each thing at its place.
        """
        return cls(os.path.abspath(path), _condyle.RawCase.read_text(path))

    @classmethod
    def from_text(cls, text: str, *, folder: str | os.PathLike[str] = ".", case: Case | None = None) -> Study:
        """Reads a study from TOML.

        Args:
            text: what a study file says.
            folder: paths in it count from here.
            case: the case, where ``text`` names none; its bodies may be arrays.

        Raises:
            BadInput: with everything that is wrong with it or with its case, each thing at its place.
        """
        files: dict[str, bytes] = {}
        if case is not None:
            written = case.text.encode()
            name = f"/cases/{hashlib.blake2b(written, digest_size=6).hexdigest()}.toml"
            text = f"case = {value_text(name)}\n{text}"
            files = {**case.arrays, name: written}
        return cls(os.path.join(os.path.abspath(folder), "study"), text, files)

    @classmethod
    def from_dict(
        cls, tables: Mapping[str, Any], *, folder: str | os.PathLike[str] = ".", case: Case | None = None
    ) -> Study:
        """Makes a study of nested dictionaries; ``vary``, ``alternative``, ``limit`` and ``correlation`` are lists of them.

        What is ``None`` is left out; all else is as for :meth:`from_text`.
        """
        return cls.from_text(document(tables), folder=folder, case=case)

    @property
    def tests(self) -> int:
        """How many tests it has; of a search, at most."""
        return self._raw.tests

    @property
    def design(self) -> str:
        """How tests are chosen, such as ``"latin-hypercube"``."""
        return self._raw.design

    @property
    def inputs(self) -> list[str]:
        """Dotted paths of the keys that vary."""
        return self._raw.inputs

    @property
    def inputs_blake3(self) -> str:
        """Hash of all that the tests follow from: the case, its meshes, what varies, and the design."""
        return self._raw.inputs_blake3

    def case(self, row: int, out: str | os.PathLike[str] | None = None) -> Case:
        """The case of test ``row``, from 0, to be run by itself; of a search it is looked up in the study's folder ``out``."""
        source = self._source
        changes = self._raw.changes(row, None if out is None else os.fspath(out))
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
        """Runs every test that the folder ``out`` does not keep yet, and gives what all of them tell.

        The table has the same bytes on any number of threads, processes and machines, and after any interruption.
        A test that fails is a row with its reason, and stops nothing.

        Args:
            out: a folder for the database, the table, the answers and their page, as ``condyle study`` writes them. A
                study that was stopped, or killed, goes on where it was.
            progress: ``True`` for a bar, or what is called with a :class:`StudyProgress` as tests are kept; the study
                stops where it answers ``False``, with :class:`StudyInterrupted`, and where it raises.
            threads: tests at the same time in this process; all processors if not given.
            executor: any of ``concurrent.futures``, or what has its ``submit``: tests run there in place of threads here.
                Its workers need condyle, and the files that study and case name under the same paths.
            client: a ``dask.distributed.Client``, for the same. A task whose worker dies is done again.
            tests_a_task: tests that a worker is sent at once.

        Raises:
            BadInput: a folder of another study or in use, or a search, whose tests depend on each other, on an executor.
        """
        if executor is not None and client is not None:
            raise ValueError("give an executor or a client, not both")
        if client is not None:
            executor = client.get_executor(pure=False)
        bar = Bar() if progress is True else None
        listener = bar or (progress if callable(progress) else None)
        try:
            if executor is None:
                self._raw.run(out, threads or os.cpu_count() or 1, listener)
            else:
                run_on(executor, self._raw, self._source, os.fspath(out), tests_a_task, listener)
        finally:
            if bar:
                bar.close()
        return self.answered(out)

    def merge(self, shards: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> StudyResult:
        """Puts the tests of several folders of this study, such as those of ``--shard``, into the folder ``out``."""
        self._raw.merge([os.fspath(shard) for shard in shards], out)
        return self.answered(out)

    def answered(self, out: str | os.PathLike[str]) -> StudyResult:
        """What the tests that the folder ``out`` keeps tell by now; writes table, answers and page anew."""
        return StudyResult(Path(out), json.loads(self._raw.answers(out)))

    def __repr__(self) -> str:
        return f"<condyle.Study of {self.tests} tests, {self.design}: {', '.join(self.inputs)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Study, (self._source.path, self._source.text, dict(self._source.files))
