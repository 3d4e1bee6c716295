"""The operations. Written by ``cargo xtask python`` from their definitions; do not edit."""

from __future__ import annotations

from typing import Any, Dict, Literal, Optional, Sequence, Tuple, Union

from ._edges import Edges
from ._result import Result
from ._run import chosen, run
from ._types import FloatArray, Length, LoopName, MeshLike, Path, Point, Points, Progress, Radius, Region, Table

__all__ = [
    "blend",
    "cluster",
    "compose",
    "cut",
    "detail",
    "difference",
    "intersection",
    "pose",
    "remesh",
    "repair",
    "sharpen",
    "union",
]


def union(
    *meshes: MeshLike,
    radius: Optional[Radius] = None,
    near: Union[Point, Points] = (),
    profile: Union[str, Table] = "arc",
    alpha: float = 1.75,
    longer: Optional[Length] = None,
    multiresolution: bool = False,
    overlap: Literal["full", "shrink", "error"] = "full",
    profile_at: Union[Table, Sequence[Table]] = (),
    radius_at: Union[Table, Sequence[Table]] = (),
    reach: Optional[float] = None,
    spine: Literal["contact", "offset"] = "contact",
    surface: Literal["auto", "stitch", "field", "keep"] = "auto",
    tolerance: float = 0.005,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Join solids, and fillet the seams with a rolling ball.

    Parameters
    ----------
    *meshes : mesh-like
        Two or more, each anything that `as_mesh` takes; how they are posed is how they are.
    radius : length, or two, optional
        Blend the seams with a ball of this radius; with `R1,R2` its centre keeps R1 from the first part and R2 from
        the other.
    near : list of x, y, z, optional
        Blend only the seam nearest this point; may be given more than once.
    profile : arc, g2, chamfer, sharp, hermite, conic=W, or a path, default arc
        Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, or a file.
    alpha : 1 to 16, default 1.75
        Least reach of the two sides the ball rolls on, in radii; grows where more is needed.
    longer : length, optional
        Blend only seams longer than this.
    multiresolution : bool, default False
        Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer
        levels' details back; needs the surface `keep`.
    overlap : full, shrink, error, default full
        What to do where a ball of the full radius does not fit.
    profile_at : list of tables of at (x, y, z), profile (arc, g2, chamfer, sharp, hermite, conic=W, or a path), optional
        Cross-section at the place of a curve nearest to X,Y,Z; may be given more than once.
    radius_at : list of tables of at (x, y, z), radius (length), optional
        Radius at the place of a curve nearest to X,Y,Z; may be given more than once.
    reach : 0.1 to 100, optional
        Distance of the cross-section's apex from the ball's centre, in radii, where it is moved out along its line.
    spine : contact, offset, default contact
        What finds the path of the ball's centre.
    surface : auto, stitch, field, keep, default auto
        How the surface is put in.
    tolerance : 1e-6 to 0.5, default 0.005
        Largest distance of the blend's chords from its cross-section, as a share of the radius.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> both = fm.union(fm.box((2, 2, 2)), fm.box((1, 1, 3)), radius="2%", profile="g2")
    >>> both.report["validity"]["closed"]
    True
    """
    options: Dict[str, Any] = {
        "operation": "union",
        "radius": radius,
        "near": near,
        "profile": profile,
        "alpha": alpha,
        "longer": longer,
        "multiresolution": multiresolution,
        "overlap": overlap,
        "profile_at": profile_at,
        "radius_at": radius_at,
        "reach": reach,
        "spine": spine,
        "surface": surface,
        "tolerance": tolerance,
    }
    return run("boolean", meshes, [f"meshes[{i}]" for i in range(len(meshes))], options, precision, threads, progress)


def difference(
    *meshes: MeshLike,
    radius: Optional[Radius] = None,
    near: Union[Point, Points] = (),
    profile: Union[str, Table] = "arc",
    alpha: float = 1.75,
    longer: Optional[Length] = None,
    multiresolution: bool = False,
    overlap: Literal["full", "shrink", "error"] = "full",
    profile_at: Union[Table, Sequence[Table]] = (),
    radius_at: Union[Table, Sequence[Table]] = (),
    reach: Optional[float] = None,
    spine: Literal["contact", "offset"] = "contact",
    surface: Literal["auto", "stitch", "field", "keep"] = "auto",
    tolerance: float = 0.005,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Take solids from the first, and fillet the seams with a rolling ball.

    Parameters
    ----------
    *meshes : mesh-like
        Two or more, each anything that `as_mesh` takes; how they are posed is how they are.
    radius : length, or two, optional
        Blend the seams with a ball of this radius; with `R1,R2` its centre keeps R1 from the first part and R2 from
        the other.
    near : list of x, y, z, optional
        Blend only the seam nearest this point; may be given more than once.
    profile : arc, g2, chamfer, sharp, hermite, conic=W, or a path, default arc
        Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, or a file.
    alpha : 1 to 16, default 1.75
        Least reach of the two sides the ball rolls on, in radii; grows where more is needed.
    longer : length, optional
        Blend only seams longer than this.
    multiresolution : bool, default False
        Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer
        levels' details back; needs the surface `keep`.
    overlap : full, shrink, error, default full
        What to do where a ball of the full radius does not fit.
    profile_at : list of tables of at (x, y, z), profile (arc, g2, chamfer, sharp, hermite, conic=W, or a path), optional
        Cross-section at the place of a curve nearest to X,Y,Z; may be given more than once.
    radius_at : list of tables of at (x, y, z), radius (length), optional
        Radius at the place of a curve nearest to X,Y,Z; may be given more than once.
    reach : 0.1 to 100, optional
        Distance of the cross-section's apex from the ball's centre, in radii, where it is moved out along its line.
    spine : contact, offset, default contact
        What finds the path of the ball's centre.
    surface : auto, stitch, field, keep, default auto
        How the surface is put in.
    tolerance : 1e-6 to 0.5, default 0.005
        Largest distance of the blend's chords from its cross-section, as a share of the radius.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> drilled = fm.difference(fm.box((2, 2, 2)), fm.box((1, 1, 3)))
    >>> round(fm.info(drilled)["volume"], 9)
    6.0
    """
    options: Dict[str, Any] = {
        "operation": "difference",
        "radius": radius,
        "near": near,
        "profile": profile,
        "alpha": alpha,
        "longer": longer,
        "multiresolution": multiresolution,
        "overlap": overlap,
        "profile_at": profile_at,
        "radius_at": radius_at,
        "reach": reach,
        "spine": spine,
        "surface": surface,
        "tolerance": tolerance,
    }
    return run("boolean", meshes, [f"meshes[{i}]" for i in range(len(meshes))], options, precision, threads, progress)


def intersection(
    *meshes: MeshLike,
    radius: Optional[Radius] = None,
    near: Union[Point, Points] = (),
    profile: Union[str, Table] = "arc",
    alpha: float = 1.75,
    longer: Optional[Length] = None,
    multiresolution: bool = False,
    overlap: Literal["full", "shrink", "error"] = "full",
    profile_at: Union[Table, Sequence[Table]] = (),
    radius_at: Union[Table, Sequence[Table]] = (),
    reach: Optional[float] = None,
    spine: Literal["contact", "offset"] = "contact",
    surface: Literal["auto", "stitch", "field", "keep"] = "auto",
    tolerance: float = 0.005,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Keep what solids share, and fillet the seams with a rolling ball.

    Parameters
    ----------
    *meshes : mesh-like
        Two or more, each anything that `as_mesh` takes; how they are posed is how they are.
    radius : length, or two, optional
        Blend the seams with a ball of this radius; with `R1,R2` its centre keeps R1 from the first part and R2 from
        the other.
    near : list of x, y, z, optional
        Blend only the seam nearest this point; may be given more than once.
    profile : arc, g2, chamfer, sharp, hermite, conic=W, or a path, default arc
        Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, or a file.
    alpha : 1 to 16, default 1.75
        Least reach of the two sides the ball rolls on, in radii; grows where more is needed.
    longer : length, optional
        Blend only seams longer than this.
    multiresolution : bool, default False
        Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer
        levels' details back; needs the surface `keep`.
    overlap : full, shrink, error, default full
        What to do where a ball of the full radius does not fit.
    profile_at : list of tables of at (x, y, z), profile (arc, g2, chamfer, sharp, hermite, conic=W, or a path), optional
        Cross-section at the place of a curve nearest to X,Y,Z; may be given more than once.
    radius_at : list of tables of at (x, y, z), radius (length), optional
        Radius at the place of a curve nearest to X,Y,Z; may be given more than once.
    reach : 0.1 to 100, optional
        Distance of the cross-section's apex from the ball's centre, in radii, where it is moved out along its line.
    spine : contact, offset, default contact
        What finds the path of the ball's centre.
    surface : auto, stitch, field, keep, default auto
        How the surface is put in.
    tolerance : 1e-6 to 0.5, default 0.005
        Largest distance of the blend's chords from its cross-section, as a share of the radius.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> shared = fm.intersection(fm.box((2, 2, 2)), fm.box((1, 1, 3)))
    >>> round(fm.info(shared)["volume"], 9)
    2.0
    """
    options: Dict[str, Any] = {
        "operation": "intersection",
        "radius": radius,
        "near": near,
        "profile": profile,
        "alpha": alpha,
        "longer": longer,
        "multiresolution": multiresolution,
        "overlap": overlap,
        "profile_at": profile_at,
        "radius_at": radius_at,
        "reach": reach,
        "spine": spine,
        "surface": surface,
        "tolerance": tolerance,
    }
    return run("boolean", meshes, [f"meshes[{i}]" for i in range(len(meshes))], options, precision, threads, progress)


def blend(
    mesh: MeshLike,
    edges: Optional[Edges] = None,
    *,
    radius: Optional[Radius] = None,
    near: Union[Point, Table, Sequence[Union[Point, Table]], FloatArray] = (),
    profile: Union[str, Table] = "arc",
    along: Union[Point, Points] = (),
    alpha: float = 1.75,
    angle: float = 40.0,
    chain: bool = False,
    concave: bool = False,
    convex: bool = False,
    curves: Optional[Union[Path, Union[Table, Sequence[Table]]]] = None,
    ids: Union[int, Sequence[int]] = (),
    longer: Optional[Length] = None,
    multiresolution: bool = False,
    overlap: Literal["full", "shrink", "error"] = "full",
    profile_at: Union[Table, Sequence[Table]] = (),
    radius_at: Union[Table, Sequence[Table]] = (),
    reach: Optional[float] = None,
    seams: Optional[Union[Path, Result, Sequence[Optional[int]]]] = None,
    spine: Literal["contact", "offset"] = "contact",
    surface: Literal["auto", "stitch", "field", "keep"] = "auto",
    tolerance: float = 0.005,
    within: Optional[MeshLike] = None,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Fillet feature curves with a rolling ball.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    edges : Edges, optional
        Which edges; all over 40 degrees where not given. See `edges`.
    radius : length, or two, optional
        Radius of the ball; with `R1,R2` its centre keeps R1 from the side to the left of a curve and R2 from the
        other.
    near : list of x, y, z, or a table of at and radius, optional
        Blend only the feature curve nearest this point; may be given more than once, each with a radius of its own.
    profile : arc, g2, chamfer, sharp, hermite, conic=W, or a path, default arc
        Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, or a file.
    along : list of x, y, z, optional
        Only curves whose every edge is parallel to this direction, or to one of several, within 5 degrees.
    alpha : 1 to 16, default 1.75
        Least reach of the two sides the ball rolls on, in radii; grows where more is needed.
    angle : between 0 and 180, default 40
        Least angle between the normals of two neighbouring faces that makes their edge a feature, in degrees.
    chain : bool, default False
        Take the feature curves that continue a named one, too: from its end, within 25 degrees.
    concave : bool, default False
        Only valleys, as between a post and a plate.
    convex : bool, default False
        Only ridges, as the edges of a box.
    curves : path, optional
        Blend the curves in this file, as `features` writes them.
    ids : list of whole numbers, optional
        Blend only these feature curves, by the ids that `features` lists at the same angle.
    longer : length, optional
        Only curves longer than this.
    multiresolution : bool, default False
        Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer
        levels' details back; needs the surface `keep`.
    overlap : full, shrink, error, default full
        What to do where a ball of the full radius does not fit.
    profile_at : list of tables of at (x, y, z), profile (arc, g2, chamfer, sharp, hermite, conic=W, or a path), optional
        Cross-section at the place of a curve nearest to X,Y,Z; may be given more than once.
    radius_at : list of tables of at (x, y, z), radius (length), optional
        Radius at the place of a curve nearest to X,Y,Z; may be given more than once.
    reach : 0.1 to 100, optional
        Distance of the cross-section's apex from the ball's centre, in radii, where it is moved out along its line.
    seams : path, optional
        Blend the seams of an earlier boolean: the edges between faces of different parts in the file of its origins.
    spine : contact, offset, default contact
        What finds the path of the ball's centre.
    surface : auto, stitch, field, keep, default auto
        How the surface is put in.
    tolerance : 1e-6 to 0.5, default 0.005
        Largest distance of the blend's chords from its cross-section, as a share of the radius.
    within : path, optional
        Only curves inside or on this closed solid.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> round = fm.blend(fm.box((1, 1, 1)), radius=0.1)
    >>> round.report["figures"]["strips"]
    12.0
    """
    options: Dict[str, Any] = {
        "radius": radius,
        "near": near,
        "profile": profile,
        "along": along,
        "alpha": alpha,
        "angle": angle,
        "chain": chain,
        "concave": concave,
        "convex": convex,
        "curves": curves,
        "ids": ids,
        "longer": longer,
        "multiresolution": multiresolution,
        "overlap": overlap,
        "profile_at": profile_at,
        "radius_at": radius_at,
        "reach": reach,
        "seams": seams,
        "spine": spine,
        "surface": surface,
        "tolerance": tolerance,
        "within": within,
    }
    options = chosen(edges, options)
    return run("blend", [mesh], ["mesh"], options, precision, threads, progress)


def sharpen(
    mesh: MeshLike,
    *,
    radius: Optional[Length] = None,
    near: Union[Point, Points] = (),
    angle: float = 40.0,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Take fillets back to edges.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    radius : length, optional
        What is rounded by this radius or less is taken back; as it is rounded at each point where left out.
    near : list of x, y, z, optional
        A point on the fillet; may be given more than once.
    angle : between 0 and 180, default 40
        Least angle between the normals of two neighbouring faces that makes their edge a crease, at which fillets
        end, in degrees.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> round = fm.blend(fm.box((1, 1, 1)), fm.edges().near((0.5, 0.5, 0)), radius=0.2)
    >>> sharp = fm.sharpen(round, near=(0.45, 0.45, 0))
    >>> bool(abs(fm.info(sharp)["volume"] - 1) < 1e-9)
    True
    """
    options: Dict[str, Any] = {
        "radius": radius,
        "near": near,
        "angle": angle,
    }
    return run("sharpen", [mesh], ["mesh"], options, precision, threads, progress)


def compose(
    *meshes: MeshLike,
    edge_length: Optional[Length] = None,
    adjust: Optional[Length] = None,
    cell: float = 1.0,
    crease: Union[float, Table] = 0.0,
    kernel: Literal["triharmonic", "biharmonic", "hermite"] = "triharmonic",
    loops: Union[LoopName, Sequence[LoopName]] = (),
    method: Literal["implicit", "montage"] = "implicit",
    rings: Optional[int] = None,
    silhouette: Union[Table, Sequence[Table]] = (),
    space: float = 1.0,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Join the openings of parts by one smooth surface, leaving the parts as they are.

    Parameters
    ----------
    *meshes : mesh-like
        Two or more, each anything that `as_mesh` takes; how they are posed is how they are.
    edge_length : length, optional
        Edge length of the surface away from the openings; that of the nearest openings where left out.
    adjust : length, optional
        Trim openings nearer than this to one of another part back along their own part.
    cell : number above 0, default 1
        Size of the tessellation's cells, as a share of the openings' mean edge.
    crease : degrees, or a table by names of loops, default 0
        By how many degrees the surface turns inward where it leaves the openings, -90 to 90; negative outward.
    kernel : triharmonic, biharmonic, hermite, default triharmonic
        Kernel of the field.
    loops : list of "part:loop" or "part", optional
        Join only this loop; may be given more than once, all open boundaries where left out.
    method : implicit, montage, default implicit
        How the field is held at the openings.
    rings : 0 to 16, optional
        Rings of vertices around each opening that the field interpolates; where left out 3, for the kernel `hermite`
        1, for the method `montage` 0.
    silhouette : list of tables of control (list of x, y, z), depth (number, or two), hole (true, false), stroke (list of x, y, z), strokes (list of list of x, y, z), view (x, y, z), optional
        Silhouettes that the surface shall have.
    space : number above 0, default 1
        How far from the openings the surface may go, in diagonals of the box around them.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> upper = fm.cut(fm.sphere(1, (0, 0, 2)), plane=((0, 0, 1.5), (0, 0, -1)))
    >>> lower = fm.cut(fm.sphere(1, (0, 0, 0)), plane=((0, 0, 0.5), (0, 0, 1)))
    >>> whole = fm.compose(lower, upper)
    >>> whole.report["validity"]["closed"]
    True
    """
    options: Dict[str, Any] = {
        "edge_length": edge_length,
        "adjust": adjust,
        "cell": cell,
        "crease": crease,
        "kernel": kernel,
        "loops": loops,
        "method": method,
        "rings": rings,
        "silhouette": silhouette,
        "space": space,
    }
    return run("compose", meshes, [f"meshes[{i}]" for i in range(len(meshes))], options, precision, threads, progress)


def cut(
    mesh: MeshLike,
    *,
    plane: Optional[Union[Table, Tuple[Point, Point]]] = None,
    path: Union[Point, Points] = (),
    crease: float = 4.0,
    keep: Literal["larger", "smaller"] = "larger",
    seed: Optional[Point] = None,
    smooth: int = 0,
    snap: Optional[float] = None,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Take away what lies beyond a plane or a path over the surface, leaving a clean opening.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    plane : tables of normal (x, y, z), point (x, y, z), optional
        A point of the plane and its normal; the side the normal points away from is kept.
    path : list of x, y, z, optional
        Cut along a closed path over the surface through these points, two or more, in concave creases where there are
        any.
    crease : 0 to 1000, default 4
        How strongly creases attract the path; 0 gives the geodesic.
    keep : larger, smaller, default larger
        Which side of the path stays.
    seed : x, y, z, optional
        With a plane, cut only the contour nearest this point; with a path, keep the side nearest to it.
    smooth : 0 to 65535, default 0
        Rounds by which the boundary loop is made smooth on the surface.
    snap : 0 to 0.25, optional
        Move crossings onto vertices nearer than this share of an edge, which gives openings without short edges; 1e-6
        where left out, 0.05 for a path.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> half = fm.cut(fm.sphere(1.0), plane=((0, 0, 0.1), (0, 0, 1)))
    >>> len(fm.info(half)["boundary_loops"])
    1
    """
    options: Dict[str, Any] = {
        "plane": plane,
        "path": path,
        "crease": crease,
        "keep": keep,
        "seed": seed,
        "smooth": smooth,
        "snap": snap,
    }
    return run("cut", [mesh], ["mesh"], options, precision, threads, progress)


def detail(
    mesh: MeshLike,
    *,
    target: Optional[Region] = None,
    source: Union[Region, Sequence[Region]] = (),
    along: Optional[Points] = None,
    fan: Union[float, str] = "diagonal",
    intensity: float = 1.0,
    mode: Optional[Literal["unstructured", "structured"]] = None,
    search: Literal["indexed", "exhaustive"] = "indexed",
    source_along: Optional[Points] = None,
    spacing: Optional[Length] = None,
    wavelength: Optional[Length] = None,
    width: Optional[Length] = None,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Give a smooth region the geometry detail of another.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    target : tables of faces (list of whole numbers), file (text), group (text), near (x, y, z), origin (text), part (text), radius (length), optional
        What gets detail: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE (`origin=transition` for what `compose` made),
        or a file of face ids.
    source : list of tables of faces (list of whole numbers), file (text), group (text), near (x, y, z), origin (text), part (text), radius (length), optional
        Where detail is taken from: a region of the same mesh, or FILE:REGION of another; may be given more than once.
    along : list of x, y, z, optional
        Continue detail patch by patch along this curve, which leads from detail into the target, before all else.
    fan : length, diagonal, edges, default diagonal
        How far around a vertex similarity is judged: `diagonal` (1% of it, at least `edges`), `edges` (1.5 longest
        edges), or a length.
    intensity : number, default 1
        Factor of the detail; negative turns bumps into dents.
    mode : unstructured, structured, optional
        Whether detail is continued along a curve; by the curve where left out.
    search : indexed, exhaustive, default indexed
        How the most similar place is searched for; both find the same.
    source_along : list of x, y, z, optional
        The curve on the source, where that is another mesh; that of the target where left out.
    spacing : length, optional
        Distance of patches along the curve; a quarter of the width where left out.
    wavelength : length, optional
        What is shorter than this counts as detail; twelve mean edges of the first source where left out.
    width : length, optional
        Width of the band along the curve; the whole target where left out.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> ball = fm.sphere(1.0, segments=64)
    >>> up, down = {"near": (0, 0, 1), "radius": 0.4}, {"near": (0, 0, -1), "radius": 0.6}
    >>> same = fm.detail(ball, target=up, source=down)
    >>> len(same.vertices) == len(ball.vertices)
    True
    """
    options: Dict[str, Any] = {
        "target": target,
        "source": source,
        "along": along,
        "fan": fan,
        "intensity": intensity,
        "mode": mode,
        "search": search,
        "source_along": source_along,
        "spacing": spacing,
        "wavelength": wavelength,
        "width": width,
    }
    return run("detail", [mesh], ["mesh"], options, precision, threads, progress)


def cluster(
    mesh: MeshLike,
    *,
    all_sharp: bool = False,
    bulge: float = 0.0,
    clusters: Optional[Union[Path, Union[Table, Sequence[Table]]]] = None,
    continuity: int = 1,
    cut: float = 0.36,
    degree: Optional[Union[int, Sequence[int]]] = None,
    extent: float = 0.7,
    follow: float = 0.5,
    mu: float = 0.5,
    order: Optional[int] = None,
    sharp: Sequence[Tuple[int, int]] = (),
    singles: bool = False,
    tolerance: float = 0.0002,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Round a polyhedron: one patch for each cluster of its edges, in contact with the faces around.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    all_sharp : bool, default False
        Keep all edges between clusters sharp.
    bulge : number, default 0
        0 for the fairest patches, towards 1 sharper ones.
    clusters : path, optional
        Take the clusters from this file (docs/cluster.md) instead of choosing them.
    continuity : 1 to 8, default 1
        Order of contact between patches and faces.
    cut : between 0 and 0.5, default 0.36
        Where strips cut the patches' corners off: the share of each side, in (0, 0.5).
    degree : whole number, or two, optional
        Degree of the patches, or two degrees for four-sided ones; 2g + 1 where left out.
    extent : number above 0, default 0.7
        How far patches reach along their open edges, as a share of the edge in (0, 1]; shortened where blends would
        meet.
    follow : number, default 0.5
        How far into the corner a strip follows its patch, as a share of the cut, in [0, 1).
    mu : between 0 and 1, default 0.5
        Balance of the strips along open edges, in (0, 1): above ½ they follow the first patch longer.
    order : 0 to 8, optional
        Order of contact between strips and patches; that of the patches with the faces where left out.
    sharp : list of pair of vertices, optional
        Keep the edge between vertices A and B sharp; may be given more than once.
    singles : bool, default False
        Choose one cluster for each vertex.
    tolerance : 1e-7 to 0.1, default 2e-4
        Largest distance of the mesh's chords from the surface, as a share of the polyhedron's diagonal.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> round = fm.cluster(fm.box((1, 1, 1)))
    >>> round.report["figures"]["patches"]
    8.0
    """
    options: Dict[str, Any] = {
        "all_sharp": all_sharp,
        "bulge": bulge,
        "clusters": clusters,
        "continuity": continuity,
        "cut": cut,
        "degree": degree,
        "extent": extent,
        "follow": follow,
        "mu": mu,
        "order": order,
        "sharp": sharp,
        "singles": singles,
        "tolerance": tolerance,
    }
    return run("cluster", [mesh], ["mesh"], options, precision, threads, progress)


def remesh(
    mesh: MeshLike,
    *,
    edge_length: Optional[Length] = None,
    angle: float = 40.0,
    iterations: int = 5,
    region: Optional[Region] = None,
    smooth: Optional[str] = None,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Make triangles even; boundaries and features are kept.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    edge_length : length, optional
        Wanted edge length; without it the triangles stay.
    angle : number above 0, default 40
        Least angle between the normals of two neighbouring faces that makes their edge a feature, in degrees; 180
        keeps none.
    iterations : 1 to 1000, default 5
        Rounds of splitting, collapsing, flipping and relaxing.
    region : region, optional
        Work on these faces only: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE, or a file of face ids.
    smooth : taubin, taubin=ROUNDS, flow=LENGTH, harmonic, biharmonic, triharmonic, optional
        Move the vertices first: taubin, taubin=ROUNDS, flow=LENGTH, harmonic, biharmonic or triharmonic.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> even = fm.remesh(fm.sphere(1.0), edge_length=0.2)
    >>> even.report["validity"]["closed"]
    True
    """
    options: Dict[str, Any] = {
        "edge_length": edge_length,
        "angle": angle,
        "iterations": iterations,
        "region": region,
        "smooth": smooth,
    }
    return run("remesh", [mesh], ["mesh"], options, precision, threads, progress)


def repair(
    mesh: MeshLike,
    *,
    gap: Length = "0.001%",
    holes: Literal["refuse", "fill", "keep"] = "refuse",
    skip: Union[Literal["weld", "flat", "duplicates", "cracks", "orient", "split"], Sequence[Literal["weld", "flat", "duplicates", "cracks", "orient", "split"]]] = (),
    specks: Optional[Length] = None,
    weld: Length = 0.0,
    precision: Literal["f64", "f32"] = "f64",
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Make a mesh a solid: weld, orient, split, drop what has no area, close cracks, fill holes.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    gap : length, default 0.001%
        Close cracks up to this width: boundary edges that nearly coincide become one.
    holes : refuse, fill, keep, default refuse
        What becomes of holes.
    skip : list of weld, flat, duplicates, cracks, orient, split, optional
        Leave out this step; may be given more than once.
    specks : length, optional
        Drop components whose bounding box has a diagonal below this.
    weld : length, default 0
        Merge vertices no further apart than this; 0 merges those at the same place.
    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> box = fm.box((1, 1, 1))
    >>> soup = fm.Mesh(box.vertices[box.faces].reshape(-1, 3), [[3 * f, 3 * f + 1, 3 * f + 2] for f in range(12)])
    >>> round(fm.info(fm.repair(soup))["volume"], 9)
    1.0
    """
    options: Dict[str, Any] = {
        "gap": gap,
        "holes": holes,
        "skip": skip,
        "specks": specks,
        "weld": weld,
    }
    return run("repair", [mesh], ["mesh"], options, precision, threads, progress)


def pose(
    mesh: MeshLike,
    *,
    scale: float = 1.0,
    rotate: Optional[Union[Table, Tuple[Point, float]]] = None,
    translate: Optional[Point] = None,
    drop: Optional[MeshLike] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Result:
    """Move a mesh: scale it, turn it, shift it, set it down on another.

    Parameters
    ----------
    mesh : mesh-like
        Anything that `as_mesh` takes.
    scale : number above 0, default 1
        Scale about the origin, first.
    rotate : tables of angle (number), axis (x, y, z), optional
        Turn about an axis through the origin by degrees, counter-clockwise seen against the axis; after scaling.
    translate : x, y, z, optional
        Shift, after turning.
    drop : path, optional
        Set it down on this mesh, last of all: along z, to where it would come to rest from high above, whether it
        stands above, within or below.
    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> moved = fm.pose(fm.box((1, 1, 1)), rotate=((0, 0, 1), 45), translate=(0, 0, 2))
    >>> round(float(moved.vertices[:, 0].max()), 9)
    0.707106781
    """
    options: Dict[str, Any] = {
        "scale": scale,
        "rotate": rotate,
        "translate": translate,
        "drop": drop,
    }
    return run("pose", [mesh], ["mesh"], options, "f64", threads, progress)
