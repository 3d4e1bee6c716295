//! What can be typed.

use crate::length::angle;
use crate::shared_args::{Common, Source, Target};
use crate::verbs::batch::BatchArgs;
use crate::verbs::blend::BlendArgs;
use crate::verbs::boolean::BooleanArgs;
use crate::verbs::cluster::ClusterArgs;
use crate::verbs::compose::ComposeArgs;
use crate::verbs::cut::{CutArgs, spread_path};
use crate::verbs::detail::DetailArgs;
use crate::verbs::grid::GridArgs;
use crate::verbs::pose::PoseArgs;
use crate::verbs::remesh::RemeshArgs;
use crate::verbs::repair::RepairArgs;
use crate::verbs::run::RunArgs;
use crate::verbs::sharpen::SharpenArgs;
use crate::verbs::summary::SummaryArgs;
use crate::verbs::worker::WorkerArgs;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use fusion::operation::{Length, direction};
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;

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

#[derive(Subcommand)]
pub enum Verb {
    /// Measure and check a mesh
    Info(Info),
    /// Convert between formats
    Convert(Convert),
    /// Make a mesh a solid: weld, orient, split, drop what has no area, close cracks, fill holes
    Repair(RepairArgs),
    /// List the feature curves of a mesh
    Features(Features),
    /// Join solids into one
    Union(BooleanArgs),
    /// Take all other solids away from the first
    Difference(BooleanArgs),
    /// Keep what all solids share
    Intersection(BooleanArgs),
    /// Fillet feature curves with a rolling ball; `chamfer` stands for `blend --profile chamfer`
    #[command(visible_alias = "fillet")]
    Blend(BlendArgs),
    /// Chamfer feature curves: `blend --profile chamfer`
    #[command(hide = true, mut_arg("profile", |a| a.hide(true).default_value("chamfer")))]
    Chamfer(BlendArgs),
    /// Take fillets back to edges
    Sharpen(SharpenArgs),
    /// Join the openings of parts by one smooth surface, leaving the parts as they are
    Compose(ComposeArgs),
    /// Give a smooth region the geometry detail of another
    Detail(DetailArgs),
    /// Round a polyhedron: one patch for each cluster of its edges, in contact with the faces around
    Cluster(ClusterArgs),
    /// Make triangles even; boundaries and features are kept
    Remesh(RemeshArgs),
    /// Move a mesh: scale it, turn it, shift it, set it down on another
    Pose(PoseArgs),
    /// Take away what lies beyond a plane or a path over the surface, leaving a clean opening
    Cut(CutArgs),
    /// Evaluate a document: parts, and any operations on them in any order, from one TOML file
    Run(RunArgs),
    /// Replay many documents in worker processes, one line of results each
    Batch(BatchArgs),
    /// Answer requests of `batch`
    #[command(hide = true)]
    Worker(WorkerArgs),
    /// Write a line of a jobs file for each combination of parameters
    Grid(GridArgs),
    /// Sum up the results of `batch` on one page
    Summary(SummaryArgs),
    /// Draw a still picture
    Render(Render),
    /// Build the showcase models with their reports and pictures; needs no input
    Demo(Demo),
    /// Print a script that lets a shell complete verbs, options and files
    Completions(Completions),
    /// Print the JSON schema of documents, operations and their options
    Schema,
    /// Print the manual page, or write one for every verb
    Man(Man),
}

impl Verb {
    /// Its name, as typed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Info(_) => "info",
            Self::Convert(_) => "convert",
            Self::Repair(_) => "repair",
            Self::Features(_) => "features",
            Self::Union(_) => "union",
            Self::Difference(_) => "difference",
            Self::Intersection(_) => "intersection",
            Self::Blend(_) | Self::Chamfer(_) => "blend",
            Self::Sharpen(_) => "sharpen",
            Self::Compose(_) => "compose",
            Self::Detail(_) => "detail",
            Self::Cluster(_) => "cluster",
            Self::Remesh(_) => "remesh",
            Self::Pose(_) => "pose",
            Self::Cut(_) => "cut",
            Self::Run(_) => "run",
            Self::Batch(_) => "batch",
            Self::Worker(_) => "worker",
            Self::Grid(_) => "grid",
            Self::Summary(_) => "summary",
            Self::Render(_) => "render",
            Self::Demo(_) => "demo",
            Self::Completions(_) => "completions",
            Self::Schema => "schema",
            Self::Man(_) => "man",
        }
    }
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
    #[arg(long, hide_short_help = true, value_name = "FILE.json")]
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

/// The command line, with a line in every verb's short help that names the options of all verbs.
pub fn command() -> clap::Command {
    Cli::command().mut_subcommands(|verb| verb.after_help(COMMON_HELP))
}

const COMMON_HELP: &str = "\
Of every verb: --report FILE, --strict, --quiet, -v, --threads N, --time-limit S; more with --help.";

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

    #[test]
    fn a_path_takes_several_points() {
        for line in [
            "fusion-cli cut a.obj -o b.obj --path -1,0,0 0,-1,0 1,0,0",
            "fusion-cli cut --path -1,0,0 0,-1,0 --path 1,0,0 a.obj -o b.obj",
        ] {
            let Verb::Cut(cut) = parse(line).unwrap().verb else { panic!("{line}") };
            assert_eq!((cut.cut.path.len(), cut.input), (3, "a.obj".into()), "{line}");
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

    /// A screen has 45 lines of 100 columns.
    #[test]
    fn short_help_fits_on_a_screen() {
        let mut wrong = vec![];
        for verb in command().get_subcommands_mut() {
            let help = verb.render_help().to_string();
            let lines = help.lines().count();
            if lines > 45 || help.lines().any(|line| line.chars().count() > 100) {
                wrong.push(format!("{}: {lines} lines\n{help}", verb.get_name()));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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
