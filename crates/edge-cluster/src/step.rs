//! STEP: tensor-product patches as B-spline surfaces, faces as planes trimmed by the patches' boundary curves.
//!
//! Written out by hand: the entities needed are few, and the kernels that write STEP bring their own topology. S-patches
//! and strips have no STEP entity (they are rational of degree n·(m − 2) over a polygon, and compositions of patches):
//! S-patches are left open, and layouts with strips are refused.

use crate::control::Shape;
use crate::error::Error;
use crate::layout::Layout;
use crate::polyhedron::Polyhedron;
use glam::DVec3;
use std::fmt::Write;

/// A model as the text of a STEP file (AP214).
#[derive(Clone, Debug)]
pub struct Step {
    /// The file.
    pub text: String,
    /// S-patches that are left out; the shell is closed if there are none.
    pub left_out: usize,
}

/// The blend as boundary representation: exact, with shared edges. Lengths are written as millimetres.
///
/// # Errors
/// [`Error::NoStep`] where strips run along open edges.
pub fn to_step(solid: &Polyhedron, layout: &Layout) -> Result<Step, Error> {
    if !layout.strips.is_empty() {
        return Err(Error::NoStep { strips: layout.strips.len() });
    }
    let mut file = File::default();
    let kept: Vec<usize> = solid.positions.iter().map(|&p| file.vertex(p)).collect();
    let tips: Vec<Vec<usize>> = (0..layout.patches.len())
        .map(|c| (0..layout.clusters[c].sides()).map(|k| file.vertex(layout.tip(c, k))).collect())
        .collect();
    let sides: Vec<Vec<usize>> = (0..layout.patches.len())
        .map(|c| {
            let (net, m) = (&layout.nets[c], layout.clusters[c].sides());
            let side = |k: usize| {
                let points: Vec<DVec3> = net.shape.border(k).into_iter().map(|i| net.points[i]).collect();
                let curve = file.curve(&points);
                file.add(&format!("EDGE_CURVE('',#{},#{},#{curve},.T.)", tips[c][k], tips[c][(k + 1) % m]))
            };
            (0..m).map(side).collect()
        })
        .collect();
    // What is left of each edge outside the clusters, by its lower halfedge.
    let end = |h: u32| layout.corner_of[h as usize].map(|(c, k)| (tips[c][k], layout.tip(c, k)));
    let straight: Vec<Option<usize>> = (0..solid.halfedges.len() as u32)
        .map(|h| {
            let half = solid.halfedges[h as usize];
            let inside = |v: u32| layout.cluster_of[v as usize];
            let backbone = inside(half.tail).is_some() && inside(half.tail) == inside(half.head);
            if backbone || half.twin < h {
                return None;
            }
            let at = |v: u32| (kept[v as usize], solid.positions[v as usize]);
            let ((a, p), (b, _)) = (end(h).unwrap_or(at(half.tail)), end(half.twin).unwrap_or(at(half.head)));
            let line = file.line(p, solid.vector(h));
            Some(file.add(&format!("EDGE_CURVE('',#{a},#{b},#{line},.T.)")))
        })
        .collect();
    let mut faces = vec![];
    for face in &solid.faces {
        let loops: Vec<Vec<(usize, bool)>> = face
            .loops
            .iter()
            .map(|&start| {
                let mut edges = vec![];
                for h in solid.loop_from(start) {
                    let half = solid.halfedges[h as usize];
                    edges.extend(straight[h.min(half.twin) as usize].map(|e| (e, h < half.twin)));
                    if let Some((c, l)) = layout.corner_of[half.twin as usize] {
                        let m = layout.clusters[c].sides();
                        edges.push((sides[c][(l + m - 1) % m], false));
                    }
                }
                edges
            })
            .collect();
        let plane = file.plane(face.plane.offset * face.plane.normal, face.plane.normal);
        faces.push(file.face(plane, &loops));
    }
    let mut left_out = 0;
    for (c, net) in layout.nets.iter().enumerate() {
        if let Shape::Tensor(degrees) = net.shape {
            let surface = file.surface(degrees, &net.points);
            faces.push(file.face(surface, &[sides[c].iter().map(|&e| (e, true)).collect()]));
        } else {
            left_out += 1;
        }
    }
    Ok(Step { text: file.finish(&faces, left_out == 0), left_out })
}

/// Numbered entities, in the order in which they refer to each other.
#[derive(Default)]
struct File {
    data: String,
    count: usize,
}

impl File {
    fn add(&mut self, entity: &str) -> usize {
        self.count += 1;
        // Writing to a string cannot fail.
        let _ = writeln!(self.data, "#{}={entity};", self.count);
        self.count
    }

    fn point(&mut self, p: DVec3) -> usize {
        self.add(&format!("CARTESIAN_POINT('',({}))", numbers(p)))
    }

    fn direction(&mut self, d: DVec3) -> usize {
        self.add(&format!("DIRECTION('',({}))", numbers(d)))
    }

    fn vertex(&mut self, p: DVec3) -> usize {
        let point = self.point(p);
        self.add(&format!("VERTEX_POINT('',#{point})"))
    }

    fn line(&mut self, p: DVec3, d: DVec3) -> usize {
        let (point, direction) = (self.point(p), self.direction(d.normalize_or(DVec3::X)));
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        self.add(&format!("LINE('',#{point},#{vector})"))
    }

    fn curve(&mut self, points: &[DVec3]) -> usize {
        let n = points.len() - 1;
        let ids: Vec<usize> = points.iter().map(|&p| self.point(p)).collect();
        self.add(&format!(
            "B_SPLINE_CURVE_WITH_KNOTS('',{n},{},.UNSPECIFIED.,.F.,.F.,({m},{m}),(0.,1.),.UNSPECIFIED.)",
            list(&ids),
            m = n + 1
        ))
    }

    fn surface(&mut self, [a, b]: [usize; 2], points: &[DVec3]) -> usize {
        let rows: Vec<String> =
            points.chunks(b + 1).map(|row| list(&row.iter().map(|&p| self.point(p)).collect::<Vec<_>>())).collect();
        self.add(&format!(
            "B_SPLINE_SURFACE_WITH_KNOTS('',{a},{b},({}),.UNSPECIFIED.,.F.,.F.,.F.,({p},{p}),({q},{q}),(0.,1.),(0.,1.),.UNSPECIFIED.)",
            rows.join(","),
            p = a + 1,
            q = b + 1
        ))
    }

    fn placement(&mut self, at: DVec3, normal: DVec3) -> usize {
        let (point, axis) = (self.point(at), self.direction(normal));
        let across = self.direction(normal.any_orthonormal_vector());
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{point},#{axis},#{across})"))
    }

    fn plane(&mut self, at: DVec3, normal: DVec3) -> usize {
        let placement = self.placement(at, normal);
        self.add(&format!("PLANE('',#{placement})"))
    }

    fn face(&mut self, surface: usize, loops: &[Vec<(usize, bool)>]) -> usize {
        let bound = |edges: &Vec<(usize, bool)>| {
            let oriented = edges.iter().map(|&(edge, along)| {
                self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},.{}.)", if along { 'T' } else { 'F' }))
            });
            let oriented: Vec<usize> = oriented.collect();
            let ring = self.add(&format!("EDGE_LOOP('',{})", list(&oriented)));
            self.add(&format!("FACE_BOUND('',#{ring},.T.)"))
        };
        let bounds: Vec<usize> = loops.iter().map(bound).collect();
        self.add(&format!("ADVANCED_FACE('',{},#{surface},.T.)", list(&bounds)))
    }

    fn finish(mut self, faces: &[usize], closed: bool) -> String {
        let faces = list(faces);
        let (body, kind) = if closed {
            let shell = self.add(&format!("CLOSED_SHELL('',{faces})"));
            (self.add(&format!("MANIFOLD_SOLID_BREP('',#{shell})")), "ADVANCED_BREP_SHAPE_REPRESENTATION")
        } else {
            let shell = self.add(&format!("OPEN_SHELL('',{faces})"));
            (self.add(&format!("SHELL_BASED_SURFACE_MODEL('',(#{shell}))")), "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")
        };
        let context = self.add("APPLICATION_CONTEXT('automotive design')");
        self.add(&format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{context})"
        ));
        let product_context = self.add(&format!("PRODUCT_CONTEXT('',#{context},'mechanical')"));
        let product = self.add(&format!("PRODUCT('polyhedron','polyhedron','',(#{product_context}))"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let design = self.add(&format!("PRODUCT_DEFINITION_CONTEXT('part definition',#{context},'design')"));
        let definition = self.add(&format!("PRODUCT_DEFINITION('design','',#{formation},#{design})"));
        let shape = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        let length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let solid_angle = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let uncertainty = self.add(&format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),#{length},'distance_accuracy_value','')"
        ));
        let space = self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid_angle}))REPRESENTATION_CONTEXT('',''))"
        ));
        let origin = self.placement(DVec3::ZERO, DVec3::Z);
        let model = self.add(&format!("{kind}('',(#{origin},#{body}),#{space})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{shape},#{model})"));
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('polyhedron blended by edge clusters'),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
            self.data
        )
    }
}

fn list(ids: &[usize]) -> String {
    let ids: Vec<String> = ids.iter().map(|i| format!("#{i}")).collect();
    format!("({})", ids.join(","))
}

/// Coordinates with every digit; STEP wants a decimal point in each, and a capital E.
fn numbers(p: DVec3) -> String {
    let one = |x: f64| {
        let text = format!("{x:?}").to_uppercase();
        match text.split_once('E') {
            Some((digits, power)) if !digits.contains('.') => format!("{digits}.E{power}"),
            _ => text,
        }
    };
    [p.x, p.y, p.z].map(one).join(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Degree, Params, PolyhedronParams, Spec, solids};

    fn layout(model: &solids::Solid, params: &Params) -> (Polyhedron, Layout) {
        let (mesh, of) = model.triangles();
        let solid = Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap();
        let specs: Vec<Spec> = model.clusters.iter().map(|v| Spec { vertices: v.clone(), ..Spec::default() }).collect();
        let layout = Layout::new(&solid, &specs, params, &vec![1.0; solid.halfedges.len()]).unwrap();
        (solid, layout)
    }

    /// Every edge of a closed shell is used once each way, and every reference is to an earlier entity.
    #[test]
    fn a_four_sided_model_is_a_closed_shell() {
        let params = Params { all_sharp: true, degree: Some(Degree::Tensor(4, 2)), ..Params::default() };
        let (solid, layout) = layout(&solids::pressure_meter(), &params);
        let step = to_step(&solid, &layout).unwrap();
        assert_eq!((step.left_out, step.text.matches("=ADVANCED_FACE").count()), (0, 10));
        let mut uses = std::collections::BTreeMap::<&str, [usize; 2]>::new();
        for line in step.text.lines() {
            let Some((name, entity)) = line.strip_prefix('#').and_then(|l| l.split_once('=')) else { continue };
            let number: usize = name.parse().unwrap();
            for other in entity.split('#').skip(1) {
                let digits: String = other.chars().take_while(char::is_ascii_digit).collect();
                assert!(digits.parse::<usize>().unwrap() < number, "{line}");
            }
            if let Some(edge) = entity.strip_prefix("ORIENTED_EDGE('',*,*,#") {
                let (edge, sense) = edge.split_once(',').unwrap();
                uses.entry(edge).or_default()[usize::from(sense.starts_with(".T."))] += 1;
            }
        }
        // Four patches of four sides, and eight edges between them.
        assert_eq!(uses.len(), 16 + 8);
        assert!(uses.values().all(|u| *u == [1, 1]), "{uses:?}");
    }

    #[test]
    fn what_has_no_step_entity_is_left_out_or_refused() {
        let (solid, vase) = layout(&solids::vase(), &Params { all_sharp: true, ..Params::default() });
        let step = to_step(&solid, &vase).unwrap();
        assert!(step.left_out == 7 && step.text.contains("OPEN_SHELL"));
        let (solid, strips) = layout(&solids::vase(), &Params::default());
        assert!(matches!(to_step(&solid, &strips), Err(Error::NoStep { strips: 14 })));
    }

    #[test]
    fn numbers_are_as_step_wants_them() {
        assert_eq!(numbers(DVec3::new(1.0, -2.5e-20, 3e30)), "1.0,-2.5E-20,3.E30");
    }
}
