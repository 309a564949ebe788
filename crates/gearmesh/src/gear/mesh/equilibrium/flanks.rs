//! Both flanks of a pair under one design: how far they stand apart along the path of contact and across the face.
//!
//! Where a design is a sum of profiles and leads, the face is the same at every position. Where something varies over the
//! surface, the face is cut into sections, each with profiles of its own. Must not know: load, compliance.

use std::borrow::Cow;

use crate::gear::contact::CornerContact;
use crate::gear::contact::face::Face;
use crate::gear::contact::gap::Gaps;
use crate::gear::mesh::cycle::mesh::Mesh;
use crate::gear::modification::Design;
use crate::numeric::lobatto::Rule;
use crate::numeric::piecewise::Piecewise;

/// Points within a strip of a surface.
const POINTS: usize = 3;

/// The flanks of a design.
#[derive(Clone)]
pub(in crate::gear::mesh) struct Flanks<'a> {
    pub(in crate::gear::mesh) cycle: &'a Mesh,
    /// The deviation across the face, the same at every position; of a surface, that where contact starts.
    pub(in crate::gear::mesh) face: Face<'a>,
    /// Whether the face differs from position to position.
    pub(in crate::gear::mesh) is_surface: bool,
    /// Whether the face is the same on either side of its middle.
    pub(in crate::gear::mesh) is_even: bool,
    /// Of a surface that is a sum of profiles and leads: all sections have the gaps of the middle, and what their leads take off.
    is_sum: bool,
    /// In the middle of the face.
    middle: FaceSection<'a>,
    /// Of a surface those of all slices of the face, or of all its strips; otherwise none.
    sections: Vec<FaceSection<'a>>,
}

/// A section across the face.
#[derive(Clone)]
struct FaceSection<'a> {
    /// Of the width.
    share: f64,
    /// z \[m\].
    z: f64,
    /// What the leads of both gears take off \[m\].
    lead: f64,
    /// None where flanks touch all over the path, without a gap.
    gaps: Option<Gaps<'a>>,
    /// Quick copies of them.
    copies: Piecewise,
}

impl<'a> Flanks<'a> {
    pub(in crate::gear::mesh) fn new(cycle: &'a Mesh, design: &'a Design) -> Self {
        Self::of(cycle, design, design.varies_over_surface(), design.lead_is_even())
    }

    /// Of a design that is looked at as one that varies over the surface, or is not even, though it may be less than that.
    pub(in crate::gear::mesh) fn of(cycle: &'a Mesh, design: &'a Design, is_surface: bool, is_even: bool) -> Self {
        let is_sum = is_surface && !design.varies_over_surface();
        let section = |(share, z): (f64, f64)| {
            let lead = design.lead(z);
            if is_sum {
                return FaceSection { share, z, lead, gaps: None, copies: Piecewise::default() };
            }
            FaceSection::new(cycle, design, share, z, lead)
        };
        let middle = FaceSection::new(cycle, design, 1.0, 0.0, 0.0);
        if !is_surface {
            let face = Face::new(design, cycle.face_width, &cycle.slices);
            return Self { cycle, face, is_surface, is_even, is_sum, middle, sections: Vec::new() };
        }
        let half = 0.5 * cycle.face_width;
        let places = match &cycle.across {
            Some(across) => places_in(&strips(cycle, is_even), &across.rule),
            None => Face::places(design, [-half, half], &cycle.slices),
        };
        let sections = places.into_iter().map(section).collect();
        let face = Face::flat(&cycle.slices);
        let mut flanks = Self { cycle, face, is_surface, is_even, is_sum, middle, sections };
        flanks.face = flanks.face_at(cycle.pair.start_of_contact);
        flanks
    }

    /// Of a surface: the same with sections in each of these strips, which are equally wide, whatever else cuts the face.
    pub(in crate::gear::mesh) fn cut_into(&self, design: &'a Design, strips: &[[f64; 2]]) -> Self {
        let section = |(share, z): (f64, f64)| FaceSection::new(self.cycle, design, share, z, design.lead(z));
        let sections = places_in(strips, &Rule::new(POINTS)).into_iter().map(section).collect();
        Self { sections, ..self.clone() }
    }

    /// The gaps in the middle of the face; none where the flanks touch all over the path.
    pub(in crate::gear::mesh) fn in_the_middle(&self) -> Option<&Gaps<'a>> {
        self.middle.gaps.as_ref()
    }

    /// The gaps in the middle of the face, whether flanks can be apart there or not.
    pub(in crate::gear::mesh) fn gaps(&self) -> Cow<'_, Gaps<'_>> {
        self.in_the_middle().map_or_else(|| Cow::Owned(Gaps::new(&self.cycle.pair, &Default::default())), Cow::Borrowed)
    }

    /// Whether a profile is a spline through many points.
    pub(in crate::gear::mesh) fn is_sampled(&self) -> bool {
        self.sections.iter().chain([&self.middle]).filter_map(|section| section.gaps.as_ref()).any(Gaps::is_sampled)
    }

    /// Whether nothing is taken off along the profiles.
    pub(in crate::gear::mesh) fn is_unmodified(&self) -> bool {
        self.in_the_middle().is_none_or(|gaps| !gaps.is_modified())
    }

    /// Whether both flanks run parallel across the face at every position.
    #[inline]
    pub(in crate::gear::mesh) fn is_flat(&self) -> bool {
        self.face.is_flat() && !self.is_surface
    }

    /// What the gaps count from \[m\].
    #[inline]
    pub(in crate::gear::mesh) fn offset(&self) -> f64 {
        if self.is_surface { 0.0 } else { self.face.offset }
    }

    /// The gap at a path position, where the flanks come nearest; none where they are too far apart for that.
    #[inline]
    pub(in crate::gear::mesh) fn gap(&self, s: f64) -> Option<f64> {
        if self.is_surface { self.least_gap(s) } else { self.middle.gap(s) }
    }

    /// The same without quick copies.
    pub(in crate::gear::mesh) fn searched(&self, s: f64) -> Option<f64> {
        if self.is_sum {
            return self.middle.searched(s).map(|gap| gap + self.least_lead());
        }
        if self.is_surface {
            return self
                .sections
                .iter()
                .filter_map(|section| Some(section.searched(s)? + section.lead))
                .reduce(f64::min);
        }
        self.middle.searched(s)
    }

    /// The gaps at ascending path positions of flanks that are no surface, if all are quick to find.
    #[inline]
    pub(in crate::gear::mesh) fn quick_gaps<const M: usize>(&self, places: &[f64; M]) -> Option<[f64; M]> {
        if self.middle.gaps.is_none() { Some([0.0; M]) } else { self.middle.copies.values(places) }
    }

    /// Out of the way of what most designs need.
    #[cold]
    fn least_gap(&self, s: f64) -> Option<f64> {
        if self.is_sum {
            return self.middle.gap(s).map(|gap| gap + self.least_lead());
        }
        self.sections.iter().filter_map(|section| section.deviation(s)).reduce(f64::min)
    }

    /// Of all sections.
    fn least_lead(&self) -> f64 {
        self.sections.iter().map(|section| section.lead).fold(f64::INFINITY, f64::min)
    }

    /// The deviations of some sections of a surface at a path position, with their shares of the width.
    fn deviations(&self, sections: &[FaceSection], s: f64) -> Vec<(f64, f64)> {
        if self.is_sum {
            let gap = self.middle.gap(s);
            let of = |section: &FaceSection| (section.share, gap.map_or(0.0, |gap| gap + section.lead));
            return sections.iter().map(of).collect();
        }
        let of = |section: &FaceSection| (section.share, section.deviation(s).unwrap_or(0.0));
        sections.iter().map(of).collect()
    }

    /// The face of a surface at a path position, above its gap there.
    pub(in crate::gear::mesh) fn face_at(&self, s: f64) -> Face<'a> {
        Face::of_slices(self.deviations(&self.sections, s), self.gap(s).unwrap_or(0.0), &self.cycle.slices)
    }

    /// z of the smallest deviation at a path position; none where the flanks run parallel.
    pub(in crate::gear::mesh) fn lowest(&self, s: f64) -> Option<f64> {
        if !self.is_surface {
            return self.face.lowest;
        }
        let deviation = |section: &FaceSection| section.deviation(s).unwrap_or(f64::INFINITY);
        let lower = |one: &FaceSection, other: &FaceSection| deviation(other) < deviation(one);
        self.sections.iter().reduce(|one, other| if lower(one, other) { other } else { one }).map(|section| section.z)
    }

    /// The mean deviation above the gap at a path position.
    #[inline]
    pub(in crate::gear::mesh) fn mean(&self, s: f64) -> f64 {
        if self.is_surface { self.face_at(s).mean } else { self.face.mean }
    }

    /// The deviations of a surface within each of `count` strips, at a path position.
    pub(in crate::gear::mesh) fn strips_at(&self, s: f64, count: usize) -> impl Iterator<Item = Face<'a>> {
        self.sections.chunks(self.sections.len() / count).map(move |sections| {
            let mut slices = self.deviations(sections, s);
            for slice in &mut slices {
                slice.0 *= count as f64;
            }
            let lowest = slices.iter().map(|slice| slice.1).fold(f64::INFINITY, f64::min);
            Face::of_slices(slices, lowest, &self.cycle.slices)
        })
    }

    /// Makes quick copies of the gaps between two path positions. Returns the cycle positions at which they are not smooth,
    /// ascending.
    pub(in crate::gear::mesh) fn follow(&mut self, window: (f64, f64)) -> Vec<f64> {
        let pair = &self.cycle.pair;
        let fold = |s: f64| {
            let pitches = (s - pair.start_of_contact) / pair.base_pitch;
            (pitches - pitches.floor()) * pair.base_pitch
        };
        let mut folded: Vec<f64> = Vec::new();
        let is_each = self.is_surface && !self.is_sum;
        let sections = if is_each { &mut self.sections[..] } else { std::slice::from_mut(&mut self.middle) };
        for section in sections {
            if let Some(gaps) = &section.gaps {
                let breaks = gaps.breaks(window);
                section.copies = gaps.copied(&self.cycle.copies, &breaks);
                folded.extend(breaks.into_iter().map(fold));
            }
        }
        folded.sort_by(f64::total_cmp);
        if self.is_surface {
            folded.dedup();
        }
        folded
    }
}

/// Points within each of equal strips: shares of the width of them all, and z.
fn places_in(strips: &[[f64; 2]], rule: &Rule) -> Vec<(f64, f64)> {
    let share = 1.0 / strips.len() as f64;
    let within = |strip: &[f64; 2]| Face::places(&Design::default(), *strip, rule);
    strips.iter().flat_map(within).map(|(part, z)| (part * share, z)).collect()
}

/// The strips into which the face is cut where slices hold each other \[m\]; of an even face those of one half.
pub(in crate::gear::mesh) fn strips(cycle: &Mesh, even: bool) -> Vec<[f64; 2]> {
    let count = cycle.settings.slices.max(1);
    let mut strips = equal_strips(cycle.face_width, count);
    strips.truncate(if even { count.div_ceil(2) } else { count });
    strips
}

/// So many strips of a face of this width \[m\].
pub(in crate::gear::mesh) fn equal_strips(width: f64, count: usize) -> Vec<[f64; 2]> {
    let place = |index: usize| width * (index as f64 / count as f64 - 0.5);
    (0..count).map(|strip| [place(strip), place(strip + 1)]).collect()
}

impl<'a> FaceSection<'a> {
    fn new(cycle: &'a Mesh, design: &'a Design, share: f64, z: f64, lead: f64) -> Self {
        let profiles = design.profiles(z);
        let can_be_apart =
            cycle.settings.corner_contact == CornerContact::Exact || profiles.iter().any(|parts| !parts.is_empty());
        let gaps = can_be_apart.then(|| Gaps::new(&cycle.pair, &profiles));
        Self { share, z, lead, gaps, copies: Piecewise::default() }
    }

    #[inline]
    fn gap(&self, s: f64) -> Option<f64> {
        if self.gaps.is_none() {
            return Some(0.0);
        }
        self.copies.value(s).or_else(|| self.searched(s))
    }

    fn searched(&self, s: f64) -> Option<f64> {
        self.gaps.as_ref().map_or(Some(0.0), |gaps| gaps.at(s))
    }

    /// With what the leads take off.
    fn deviation(&self, s: f64) -> Option<f64> {
        self.gap(s).map(|gap| gap + self.lead)
    }
}
