//! What can be typed.

use crate::choosing::{Choosing, ChoosingSeams};
use crate::clustering::Cluster;
use crate::composing::Compose;
use crate::cutting::{Cut, spread_path};
use crate::detailing::Detail;
use crate::length::{Length, Radius, angle, angle_or_none, direction, positive_length, radius, seconds};
use crate::place::Place;
use crate::rolling::Rolling;
use crate::smoothing::Way;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

/// Joins and blends triangle meshes.
#[derive(Parser)]
#[command(name = "fusion-cli", version, after_help = AFTER_HELP, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub verb: Verb,
    #[command(flatten)]
    pub common: Common,
}

const AFTER_HELP: &str = "\
Formats follow the extension: .obj .stl .ply .off .glb .gltf .3mf; `-` is standard input or output.
Lengths are model units, or a share of the diagonal of the box around all inputs when written `2%`. Angles are degrees.

Exit codes: 0 done; 2 wrong usage; 3 input unreadable or malformed; 4 impossible on this input; 5 the result failed its
own validation; 6 the output cannot be written; 130 cancelled. Any code but 0 leaves an existing output file as it was.";

/// Options of every verb.
#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag that can be typed")]
pub struct Common {
    /// Write a machine-readable report of the job (docs/report.md lists its keys)
    #[arg(long, value_name = "FILE.json", global = true, help_heading = "Common options")]
    pub report: Option<PathBuf>,
    /// Use this many threads; the result is the same for any number
    #[arg(long, value_name = "N", global = true, help_heading = "Common options",
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Show no progress: neither a bar on a terminal nor a line every five seconds elsewhere
    #[arg(long, global = true, help_heading = "Common options")]
    pub no_progress: bool,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose", help_heading = "Common options")]
    pub quiet: bool,
    /// Say what was chosen, what each stage did and how long it took
    #[arg(short, long, global = true, help_heading = "Common options")]
    pub verbose: bool,
    /// Count any warning as a failure: exit code 4, and no output
    #[arg(long, global = true, help_heading = "Common options")]
    pub strict: bool,
    /// Stop with exit code 4 after this many seconds
    #[arg(long, value_name = "S", global = true, help_heading = "Common options", value_parser = seconds)]
    pub time_limit: Option<Duration>,
}

#[derive(Subcommand)]
pub enum Verb {
    /// Measure and check a mesh
    Info(Info),
    /// Convert between formats; repair on request
    Convert(Convert),
    /// List the feature curves of a mesh
    Features(Features),
    /// Join solids into one
    Union(Join),
    /// Take all other solids away from the first
    Difference(Join),
    /// Keep what all solids share
    Intersection(Join),
    /// Fillet feature curves with a rolling ball; `chamfer` stands for `blend --profile chamfer`
    #[command(visible_alias = "fillet")]
    Blend(Blend),
    /// Chamfer feature curves: `blend --profile chamfer`
    #[command(hide = true)]
    Chamfer(Blend),
    /// Join the openings of parts by one smooth surface, leaving the parts as they are
    Compose(Compose),
    /// Give a smooth region the geometry detail of another
    Detail(Detail),
    /// Round a polyhedron: one patch for each cluster of its edges, in contact with the faces around
    Cluster(Cluster),
    /// Make triangles even; boundaries and features are kept
    Remesh(Remesh),
    /// Take away what lies beyond a plane or a path over the surface, leaving a clean opening
    Cut(Cut),
    /// Replay a recipe: parts, cuts, poses, joins and blends from one TOML file
    Run(Run),
    /// Draw a still picture
    Render(Render),
    /// Build the showcase models with their reports and pictures; needs no input
    Demo(Demo),
    /// Print a script that lets a shell complete verbs, options and files
    Completions(Completions),
    /// Print the manual page, or write one for every verb
    Man(Man),
}

impl Verb {
    /// Its name, as typed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Info(_) => "info",
            Self::Convert(_) => "convert",
            Self::Features(_) => "features",
            Self::Union(_) => "union",
            Self::Difference(_) => "difference",
            Self::Intersection(_) => "intersection",
            Self::Blend(_) | Self::Chamfer(_) => "blend",
            Self::Compose(_) => "compose",
            Self::Detail(_) => "detail",
            Self::Cluster(_) => "cluster",
            Self::Remesh(_) => "remesh",
            Self::Cut(_) => "cut",
            Self::Run(_) => "run",
            Self::Render(_) => "render",
            Self::Demo(_) => "demo",
            Self::Completions(_) => "completions",
            Self::Man(_) => "man",
        }
    }
}

/// How standard input is read.
#[derive(Args)]
pub struct Source {
    /// Read inputs as this format (obj, stl, ply, off, glb, gltf, 3mf), whatever their extension; needed for `-`
    #[arg(long, value_name = "FORMAT")]
    pub from: Option<String>,
}

/// Where a mesh goes.
#[derive(Args)]
pub struct Target {
    /// Write the result here, or to standard output for `-`
    #[arg(short, long, value_name = "OUTPUT")]
    pub output: PathBuf,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Write where every vertex and face of the result came from, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
}

#[derive(Args)]
pub struct Info {
    /// The mesh
    pub mesh: PathBuf,
    /// Print JSON instead of a table
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub source: Source,
}

#[derive(Args)]
pub struct Convert {
    /// The mesh to convert
    pub input: PathBuf,
    #[command(flatten)]
    pub target: Target,
    #[command(flatten)]
    pub source: Source,
    /// Merge vertices at the same place, or no further apart than TOL if given
    #[arg(long, value_name = "TOL", num_args = 0..=1, default_missing_value = "0")]
    pub weld: Option<Length>,
    /// Turn faces so that neighbours agree and closed parts face outward
    #[arg(long)]
    pub orient: bool,
    /// Take apart edges with more than two faces and vertices with more than one fan
    #[arg(long)]
    pub split: bool,
}

#[derive(Args)]
pub struct Features {
    /// The mesh
    pub mesh: PathBuf,
    /// Least angle between the normals of two neighbouring faces that makes their edge a feature
    #[arg(long, value_name = "DEG", default_value = "40", value_parser = angle)]
    pub angle: f64,
    /// Write the curves here as JSON, with all their points
    #[arg(short, long, value_name = "CURVES.json")]
    pub output: Option<PathBuf>,
    /// Print JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Leave out the largest radius of each curve, which takes the longest
    #[arg(long)]
    pub no_radii: bool,
    #[command(flatten)]
    pub source: Source,
}

#[derive(Args)]
#[command(group(ArgGroup::new("ball").multiple(true)))]
pub struct Join {
    /// The solids, two or more, as they are posed in their files
    #[arg(required = true, num_args = 2.., value_name = "MESH")]
    pub inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub target: OptionalTarget,
    #[command(flatten)]
    pub source: Source,
    /// Blend the seam with a ball of this radius; with `R1,R2` its centre keeps R1 from the first part and R2 from the
    /// other
    #[arg(long, value_name = "R[,R2]", value_parser = radius, group = "ball")]
    pub radius: Option<Radius>,
    #[command(flatten)]
    pub limit: MaxRadius,
    #[command(flatten)]
    pub choosing: ChoosingSeams,
    #[command(flatten)]
    pub rolling: Rolling,
}

/// Where a mesh goes, if one is made.
#[derive(Args)]
pub struct OptionalTarget {
    /// Write the result here, or to standard output for `-`
    #[arg(short, long, value_name = "OUTPUT", required_unless_present = "max_radius")]
    pub output: Option<PathBuf>,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Write where every vertex and face of the result came from, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
}

impl OptionalTarget {
    /// The target, if there is an output.
    pub fn target(&self) -> Option<Target> {
        let output = self.output.clone()?;
        Some(Target { output, to: self.to.clone(), origins: self.origins.clone() })
    }
}

/// A question for the largest radius.
#[derive(Args)]
pub struct MaxRadius {
    /// Print the largest radius with which the curves can be blended, and what is in the way of a larger one; write nothing
    #[arg(long, conflicts_with_all = ["radius", "output"])]
    pub max_radius: bool,
    /// Print JSON instead of a sentence, with --max-radius
    #[arg(long, requires = "max_radius")]
    pub json: bool,
}

#[derive(Args)]
#[command(group(ArgGroup::new("ball").multiple(true)))]
pub struct Blend {
    /// The mesh to blend
    pub input: PathBuf,
    #[command(flatten)]
    pub target: OptionalTarget,
    #[command(flatten)]
    pub source: Source,
    /// Radius of the ball; with `R1,R2` its centre keeps R1 from the side to the left of a curve and R2 from the other,
    /// seen from outside along the points that `features` lists. With `--profile sharp --near` on a fillet: what is rounded by
    /// R or less is taken back to an edge [default there: as it is rounded at that place]
    #[arg(long, value_name = "R[,R2]", value_parser = radius, group = "ball")]
    pub radius: Option<Radius>,
    #[command(flatten)]
    pub limit: MaxRadius,
    /// Least angle between the normals of two neighbouring faces that makes their edge a feature
    #[arg(long, value_name = "DEG", default_value = "40", value_parser = angle)]
    pub angle: f64,
    #[command(flatten)]
    pub choosing: Choosing,
    #[command(flatten)]
    pub rolling: Rolling,
}

#[derive(Args)]
pub struct Remesh {
    /// The mesh to smooth and remesh
    pub input: PathBuf,
    #[command(flatten)]
    pub target: Target,
    #[command(flatten)]
    pub source: Source,
    /// Wanted edge length; without it the triangles stay
    #[arg(long, value_name = "L", value_parser = positive_length, required_unless_present = "smooth")]
    pub edge_length: Option<Length>,
    /// Move the vertices first: taubin or taubin=ROUNDS (keeps the volume), flow=LENGTH (halves waves of this length and
    /// all but removes shorter ones, shrinking), or harmonic, biharmonic, triharmonic (the region becomes the fairest
    /// surface that continues what is around it)
    #[arg(long, value_name = "WAY")]
    pub smooth: Option<Way>,
    /// Rounds of splitting, collapsing, flipping and relaxing
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub iterations: u16,
    /// Work on these faces only: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE, or a file of face ids
    #[arg(long, value_name = "REGION", allow_hyphen_values = true)]
    pub region: Option<Place>,
    /// Least angle between the normals of two neighbouring faces that makes their edge a feature; 180 keeps none
    #[arg(long, value_name = "DEG", default_value = "40", value_parser = angle_or_none)]
    pub angle: f64,
}

#[derive(Args)]
pub struct Run {
    /// The recipe, a TOML file (docs/recipes.md); paths in it are relative to it
    pub recipe: PathBuf,
    /// Write the result here and not where the recipe says
    #[arg(short, long, value_name = "OUTPUT")]
    pub output: Option<PathBuf>,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Write where every vertex and face of the result came from, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
}

#[derive(Args)]
pub struct Render {
    /// The mesh to draw
    pub mesh: PathBuf,
    /// The picture, a PNG file
    #[arg(short, long, value_name = "PICTURE.png")]
    pub output: PathBuf,
    #[command(flatten)]
    pub source: Source,
    /// Colour by what
    #[arg(long, value_enum)]
    pub color: Option<Color>,
    /// Where each face comes from, as `--origins` of another verb wrote it
    #[arg(long, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
    /// Draw the edges
    #[arg(long)]
    pub wireframe: bool,
    /// Direction from the mesh to the eye
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub view: Option<DVec3>,
    /// Look along parallel rays, so that lengths across the view compare
    #[arg(long)]
    pub parallel: bool,
    /// Width and height in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub size: u32,
}

/// What a picture shows by colour.
#[derive(Clone, Copy, ValueEnum)]
pub enum Color {
    /// Mean curvature: blue where hollow, red where bulging
    Curvature,
    /// Which input each face comes from; needs --origins
    Origin,
    /// Shape of each triangle: red for needles, green for equilateral ones
    Quality,
    /// Stripes as a mirror would show them: kinks are tangent breaks
    Zebra,
}

#[derive(Args)]
pub struct Demo {
    /// The folder to fill
    #[arg(short, long, value_name = "DIR", default_value = "demo")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Completions {
    /// The shell
    pub shell: clap_complete::Shell,
}

#[derive(Args)]
pub struct Man {
    /// Write the pages of the program and of every verb into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Gives `--weld` its default where a file name follows it, which clap would take for the tolerance, and repeats `--path` before each
/// of several points, which clap would take for options where they start with a minus.
pub fn with_bare_weld(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let arguments: Vec<OsString> = spread_path(arguments);
    let is_length = |a: Option<&OsString>| a.and_then(|a| a.to_str()).is_some_and(|a| a.parse::<Length>().is_ok());
    let bare = |i: usize| arguments[i] == "--weld" && !is_length(arguments.get(i + 1));
    (0..arguments.len()).map(|i| if bare(i) { "--weld=0".into() } else { arguments[i].clone() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn a_path_takes_several_points() {
        for line in [
            "fusion-cli cut a.obj -o b.obj --path -1,0,0 0,-1,0 1,0,0",
            "fusion-cli cut --path -1,0,0 0,-1,0 --path 1,0,0 a.obj -o b.obj",
        ] {
            let Verb::Cut(cut) = parse(line).unwrap().verb else { panic!("{line}") };
            assert_eq!((cut.path.len(), cut.input), (3, "a.obj".into()), "{line}");
        }
        assert!(parse("fusion-cli cut a.obj -o b.obj").is_err());
        assert!(parse("fusion-cli cut a.obj -o b.obj --plane 0,0,0,0,0,1 --path 0,0,0").is_err());
    }

    fn parse(line: &str) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(with_bare_weld(line.split(' ').map(OsString::from)))
    }

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn weld_takes_a_tolerance_or_none() {
        for (line, expected) in [
            ("fusion-cli convert --weld a.stl -o b.obj", Some(Length::Units(0.0))),
            ("fusion-cli convert --weld 1% a.stl -o b.obj", Some(Length::OfDiagonal(0.01))),
            ("fusion-cli convert a.stl -o b.obj --weld", Some(Length::Units(0.0))),
            ("fusion-cli convert a.stl --weld --orient --split -o b.obj", Some(Length::Units(0.0))),
            ("fusion-cli convert a.stl -o b.obj", None),
        ] {
            let Verb::Convert(convert) = parse(line).unwrap().verb else { panic!("{line}") };
            assert_eq!((convert.weld, convert.input), (expected, "a.stl".into()), "{line}");
        }
    }

    #[test]
    fn directions_may_start_with_a_minus() {
        assert!(parse("fusion-cli render a.obj -o a.png --view -1,-2,0.5").is_ok());
        assert!(parse("fusion-cli blend a.obj -o b.obj --radius 1 --near -1,0,0 --near 0,-1,0").is_ok());
    }

    #[test]
    fn a_join_needs_two_solids_and_a_radius_above_zero() {
        assert!(parse("fusion-cli union a.obj -o b.obj").is_err());
        assert!(parse("fusion-cli union a.obj b.obj -o c.obj --radius 0").is_err());
        assert!(parse("fusion-cli union a.obj b.obj -o c.obj --radius 2%").is_ok());
    }
}
