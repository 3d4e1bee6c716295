"""Documents: whole models as parts and steps, evaluated again only where something changed."""

from __future__ import annotations

import os
import warnings
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _native
from ._edges import Edges
from ._errors import FusionWarning, InputError, UsageError
from ._inputs import as_mesh
from ._mesh import Mesh
from ._progress import Bar, listener
from ._result import Result
from ._run import chosen, count, gathered
from ._types import MeshLike, Path, Progress
from ._written import write

__all__ = ["Cache", "Document", "Evaluation"]

GIGABYTE = 1_000_000_000


class Cache:
    """Results of steps, by all that they depend on. Several documents and threads may share one.

    Parameters
    ----------
    folder : path, optional
        Keep results in this folder, too, for later processes; made where there is none. What cannot be read or written there is
        computed again.
    gigabytes : float
        Remove the oldest results while the folder takes more than this.
    memory : float
        Gigabytes of memory, about.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> cache = fm.Cache(memory=0.5)
    """

    def __init__(self, folder: Optional[Path] = None, *, gigabytes: float = 10.0, memory: float = 1.0) -> None:
        for name, value in (("gigabytes", gigabytes), ("memory", memory)):
            if not 0 <= value < 1e6:
                raise ValueError(f"{name}: {value} is not a number of gigabytes")
        place = None if folder is None else os.fspath(folder)
        self._native = _native.Cache(int(memory * GIGABYTE), place, int(gigabytes * GIGABYTE))


class Evaluation:
    """What a document gives: its outputs as results, by the names of their shapes or in order, and a report for each step.

    Attributes
    ----------
    steps : list of dict
        For each step that was taken its report, with ``step``, ``name``, and ``known``: whether the result was in the cache.
    outputs : list of (str, str, Result)
        Name of the shape, its file (empty where the document names none), result.
    """

    def __init__(self, steps: List[Dict[str, Any]], outputs: List[Tuple[str, str, Result]], folder: str) -> None:
        self.steps = steps
        self.outputs = outputs
        self._folder = folder

    def __getitem__(self, name: Union[str, int]) -> Result:
        if isinstance(name, int):
            return self.outputs[name][2]
        for of, _, result in self.outputs:
            if of == name:
                return result
        raise KeyError(f"{name!r} is not an output; there are {', '.join(of for of, _, _ in self.outputs)}")

    def __len__(self) -> int:
        return len(self.outputs)

    def __iter__(self) -> Iterator[Result]:
        return (result for _, _, result in self.outputs)

    def save(self, folder: Optional[Path] = None) -> List[str]:
        """Write every output that has a file, relative to the document's folder or to another.

        Returns
        -------
        list of str
            Every file that was written.
        """
        base = self._folder if folder is None else os.fspath(folder)
        return [path for _, file, result in self.outputs if file for path in result.save(os.path.join(base, file))]

    def __repr__(self) -> str:
        known = sum(bool(step["known"]) for step in self.steps)
        return f"<fusion_mesh.Evaluation: {len(self.outputs)} outputs, {len(self.steps)} steps, {known} of them known>"


class Document:
    """A model as named parts and steps, in any order and number; docs/documents.md describes it.

    Every step is one operation on named shapes and gives a named shape. Evaluating it again after an edit takes only the
    steps that the edit touches.

    Parameters
    ----------
    text : str, optional
        The document as TOML; an empty one where not given.
    folder : path
        What its paths are relative to; `load` and `save` set it to the folder of the file.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> document = fm.Document()
    >>> document.parameter("soft", 0.1)
    >>> document.part("block", fm.box((2, 2, 2)))
    >>> document.part("post", fm.box((1, 1, 3)), translate=(0.25, 0, 0))
    >>> document.step("union", ["block", "post"], name="both", radius="$soft")
    >>> both = document.evaluate()["both"]
    >>> document.set("soft", 0.2)
    >>> softer = document.evaluate()["both"]
    >>> fm.info(softer)["volume"] > fm.info(both)["volume"]
    True
    """

    def __init__(self, text: str = "version = 2\n", *, folder: Path = "") -> None:
        self.folder = os.fspath(folder)
        self._meshes: Dict[str, Mesh] = {}
        self._cache: Optional[Cache] = None
        self._outline: Dict[str, Any] = _native.document_outline(text)
        self._text = text

    @classmethod
    def load(cls, path: Path) -> "Document":
        """Read a document from its file.

        Raises
        ------
        InputError
            It cannot be read, or is wrong: says in which line and column.
        """
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{os.fspath(path)}: {error}") from None
        try:
            return cls(text, folder=os.path.dirname(os.fspath(path)))
        except InputError as error:
            raise InputError(f"{os.fspath(path)}: {error}", error.diagnostic) from None

    def save(self, path: Path) -> List[str]:
        """Write the document, and beside it the meshes that it has in memory.

        ``fusion-cli run`` gives the same bytes then. Paths in a document are relative to its file.

        Returns
        -------
        list of str
            Every file that was written, the document last.

        Raises
        ------
        InputError
            A part is a file that is not there, seen from the document's new place.
        """
        folder = os.path.dirname(os.fspath(path))
        for part in self._outline["parts"]:
            file = os.path.join(folder, part["mesh"])
            if part["mesh"] not in self._meshes and not os.path.exists(file):
                raise InputError(f"part {part['name']!r}: there is no {file}; paths are relative to the document's file")
        files: List[str] = []
        for name, mesh in self._meshes.items():
            written, notes = _native.write((name, mesh), os.path.join(folder, name))
            files.extend(os.fspath(file) for file in written)
            for note in notes:
                warnings.warn(note, FusionWarning, stacklevel=2)
        write(path, self._text.encode("utf-8"))
        self.folder = folder
        return [*files, os.fspath(path)]

    @property
    def text(self) -> str:
        """The document as TOML."""
        return self._text

    @property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters by their names."""
        return dict(self._outline["parameters"])

    @property
    def parts(self) -> Sequence[Mapping[str, Any]]:
        """The parts in order: ``name`` and ``mesh``, its file."""
        return list(self._outline["parts"])

    @property
    def steps(self) -> Sequence[Mapping[str, Any]]:
        """The steps in order: ``do``, ``of``, ``as``, ``off``."""
        return list(self._outline["steps"])

    @property
    def outputs(self) -> Sequence[Mapping[str, Any]]:
        """The outputs in order: ``of`` and ``file``."""
        return list(self._outline["outputs"])

    @property
    def left_over(self) -> Sequence[str]:
        """The shapes that no step has taken up; the outputs of a document that names none."""
        return list(self._outline["left_over"])

    def parameter(self, name: str, value: Any) -> None:
        """Add a parameter, a value that options refer to as ``"$name"``, or give it another value."""
        self._replace(_native.document_with_parameter(self._text, name, value))

    def set(self, name: str, value: Any) -> None:
        """Give a parameter, or ``"N.option"`` with N the number of a step from 1, another value.

        Raises
        ------
        UsageError
            The parameter or step does not exist, or the value is out of range; the document is unchanged.
        """
        self._replace(_native.document_with_value(self._text, name, value))

    def part(self, name: str, mesh: MeshLike, **pose: Any) -> None:
        """Add an input.

        Parameters
        ----------
        name : str
            What steps call it.
        mesh : mesh-like
            A file, relative to the document's; or a mesh in memory, which `save` writes beside the document.
        **pose
            Where it stands: options of `pose`, and ``on`` and ``snap`` (docs/documents.md).
        """
        held: Dict[str, Mesh] = {}
        if isinstance(mesh, (str, os.PathLike)):
            file = os.fspath(mesh)
        else:
            own = as_mesh(mesh, f"part {name!r}")
            file = self._free(name, own, held)
            held[file] = own
        self._add({"part": [{"name": name, "mesh": file, **self._options(pose, held)}]}, held)

    def primitive(self, name: str, **options: Any) -> None:
        """Add a primitive that parts ride on: ``shape``, ``base``, ``axis``, ``radius`` and others (docs/documents.md)."""
        self._add({"primitive": {name: gathered(options, [])[0]}}, {})

    def step(
        self,
        do: str,
        of: Union[str, Sequence[str], None] = None,
        edges: Optional[Edges] = None,
        *,
        name: Optional[str] = None,
        off: bool = False,
        **options: Any,
    ) -> None:
        """Add a step.

        Parameters
        ----------
        do : str
            The operation: ``"union"``, ``"difference"``, ``"intersection"``, ``"blend"``, ``"sharpen"``, ``"compose"``, ``"cut"``,
            ``"detail"``, ``"cluster"``, ``"remesh"``, ``"repair"`` or ``"pose"``.
        of : str or list of str, optional
            The shapes it works on, for ``"compose"`` also their loops, ``"name:0"``; the only one that is left where not given.
        edges : Edges, optional
            Which edges ``"blend"`` takes; see `edges`.
        name : str, optional
            What the result is called; as the first of the shapes where not given.
        off : bool
            Pass over the step; its result is the first shape then.
        **options
            Those of the function of the same name. A parameter stands for a value as ``"$name"``. Meshes in memory are written
            beside the document by `save`.

        Raises
        ------
        UsageError
            The shape, operation or option does not exist, or a value is out of range; the document is unchanged.
        """
        table: Dict[str, Any] = {"do": do}
        if of is not None:
            table["of"] = of if isinstance(of, str) else list(of)
        if name is not None:
            table["as"] = name
        if off:
            table["off"] = True
        held: Dict[str, Mesh] = {}
        self._add({"step": [{**table, **self._options(chosen(edges, options), held)}]}, held)

    def output(self, file: Path, of: Optional[str] = None) -> None:
        """Add an output: a file, relative to the document's, and the shape that goes there; the only one left where not given."""
        table = {"file": os.fspath(file)}
        if of is not None:
            table["of"] = of
        self._add({"output": [table]}, {})

    def evaluate(
        self,
        *,
        cache: Optional[Cache] = None,
        precision: Optional[str] = None,
        threads: Optional[int] = None,
        progress: Progress = None,
    ) -> Evaluation:
        """Take the steps whose results are not known, and give the outputs.

        Parameters
        ----------
        cache : Cache, optional
            Where known results are; a gigabyte of memory of the document's own where not given.
        precision : {"f64", "f32"}, optional
            The coordinates in which outputs must be sound; where not given, those that each output's file can hold.
        threads : int, optional
            Number of threads; all processors where not given.
        progress : callable or bool, optional
            See `union`.

        Returns
        -------
        Evaluation
            The outputs by the names of their shapes, or, in a document that names none, every shape that is left over.

        Raises
        ------
        InputError
            A file cannot be read, or the document asks for what is not there.
        InfeasibleError
            A step is impossible; names the step.
        """
        if cache is None:
            self._cache = cache = self._cache or Cache()
        elif not isinstance(cache, Cache):
            raise TypeError(f"cache: expected a fusion_mesh.Cache, got {type(cache).__name__}")
        heard = listener(progress)
        meshes = [(path, as_mesh(mesh, path)) for path, mesh in self._meshes.items()]
        try:
            made = _native.document_evaluate(
                self._text, (self.folder, meshes), cache._native, precision, count(threads), heard
            )
        finally:
            if isinstance(heard, Bar):
                heard.close()
        for step in made["steps"]:
            for warning in step["warnings"]:
                warnings.warn(f"step {step['step']}: {warning}", FusionWarning, stacklevel=2)
        for name in self._outline["unused_parameters"]:
            warnings.warn(f"nothing refers to the parameter {name!r}", FusionWarning, stacklevel=2)
        outputs = [(made["of"], made["file"], Result(made, made["precision"])) for made in made["outputs"]]
        return Evaluation(made["steps"], outputs, self.folder)

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        about = self._outline
        return f"<fusion_mesh.Document: {len(about['parts'])} parts, {len(about['steps'])} steps, {len(about['outputs'])} outputs>"

    def _options(self, options: Mapping[str, Any], held: Dict[str, Mesh]) -> Dict[str, Any]:
        """Options as a document holds them. Meshes get names and are added to `held`; what refers to a parameter stays as it is."""
        given = dict(options)
        for name in ("within", "drop"):
            solid = given.get(name)
            if solid is not None and not isinstance(solid, (str, os.PathLike)):
                mesh = as_mesh(solid, name)
                given[name] = self._free(name, mesh, held)
                held[given[name]] = mesh
        sources = given.get("source")
        for source in sources if isinstance(sources, (list, tuple)) else [sources]:
            if isinstance(source, dict) and "mesh" in source:
                raise UsageError("source: name a shape of the document by the key `part`")
        referring = {key: value for key, value in given.items() if isinstance(value, str) and value.startswith("$")}
        plain = {key: value for key, value in given.items() if key not in referring}
        return {**gathered(plain, [])[0], **referring}

    def _free(self, name: str, mesh: Mesh, held: Mapping[str, Mesh]) -> str:
        """A file name for a mesh in memory; PLY, or OBJ for what only that can hold without loss."""
        extended = mesh.uvs is not None or mesh.face_groups is not None or mesh.face_materials is not None
        stem = "".join(c if c.isalnum() or c in "-_." else "-" for c in name)
        taken = {part["mesh"] for part in self._outline["parts"]} | set(self._meshes) | set(held)
        names = (f"{stem}{suffix}.{'obj' if extended else 'ply'}" for suffix in ["", *(f"-{i}" for i in range(2, 10**6))])
        return next(name for name in names if name not in taken)

    def _add(self, tables: Dict[str, Any], held: Mapping[str, Mesh]) -> None:
        self._replace(_native.document_extended(self._text, tables))
        self._meshes.update(held)

    def _replace(self, text: str) -> None:
        self._outline = _native.document_outline(text)
        self._text = text
