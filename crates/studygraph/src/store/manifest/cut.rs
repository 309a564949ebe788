//! The text of a manifest cut at its stages without being read: of thousands of stages a run may have to do with a few.
//!
//! Only of a text as this program writes it (`lines.rs`): whatever else there is, is read as a whole. Must not know: what any
//! field means, but that a stage begins with its name.

use std::ops::Range;

use memchr::memmem;

use super::Manifest;

const SCHEMAS: &[u8] = b"\n \"schemas\": {";
const STAGES: &[u8] = b"\n \"stages\": [\n";
/// Of a stage, and of the list.
const BEGIN: &[u8] = b"  {\n   \"name\": \"";
/// Behind a name.
const KIND: &[u8] = b"\",\n   \"kind\": \"";
const WARNINGS: &[u8] = b"\n   \"warnings\": [";
const OMISSION: &[u8] = b"\n    {\"what\": ";
const BETWEEN: &[u8] = b"\n  },\n";
const STATUS: &[u8] = b"\n   \"status\": \"";
/// Behind a status.
const WHY: &[u8] = b"\",\n   \"why\": \"";
/// What a record says of a run that found the stage's tables.
const UNCHANGED: &[u8] = b"\n   \"status\": \"hit\",\n   \"why\": \"unchanged\",";
const END: &[u8] = b"\n ]";

/// A text, and where its parts lie.
pub struct Cut<'t> {
    text: &'t [u8],
    /// Where what its tables are begins.
    schemas: usize,
    /// The records of its stages, without what stands between them.
    stages: Vec<Range<usize>>,
}

impl<'t> Cut<'t> {
    /// None where the text is not as this program writes it, or it has no stages.
    #[must_use]
    pub fn of(text: &'t [u8]) -> Option<Self> {
        let schemas = memmem::find(text, SCHEMAS)?;
        let start = schemas + memmem::find(&text[schemas..], STAGES)? + STAGES.len();
        // Inside of stages no line begins as near to the margin.
        let end = start + memmem::find(&text[start..], END)?;
        let mut stages = Vec::new();
        let mut from = start;
        let breaks = memmem::find_iter(&text[start..end], BETWEEN).map(|at| start + at);
        for next in breaks.map(|at| at + BETWEEN.len()).chain([end + 2]) {
            // Without a comma and a line feed.
            let stage = from..next - 2;
            (text[stage.clone()].starts_with(BEGIN) && text[stage.clone()].ends_with(b"\n  }")).then_some(())?;
            stages.push(stage);
            from = next;
        }
        Some(Self { text, schemas, stages })
    }

    #[must_use]
    pub fn len(&self) -> usize {
        self.stages.len()
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.stages.is_empty()
    }

    /// The names of the stages, as they are written.
    pub fn names(&self) -> impl Iterator<Item = &'t [u8]> {
        self.stages.iter().map(|stage| {
            let name = &self.text[stage.start + BEGIN.len()..stage.end];
            &name[..memchr::memchr(b'"', name).unwrap_or(0)]
        })
    }

    /// The kinds of the stages; empty where one is not a plain word.
    pub fn kinds(&self) -> impl Iterator<Item = &'t str> {
        self.stages.iter().zip(self.names()).map(|(stage, name)| {
            let behind = &self.text[stage.start + BEGIN.len() + name.len()..stage.end];
            let kind = behind.strip_prefix(KIND).unwrap_or_default();
            std::str::from_utf8(&kind[..memchr::memchr(b'"', kind).unwrap_or(0)]).unwrap_or_default()
        })
    }

    /// Of each stage whether it warns, and how much was left out in it.
    pub fn told(&self) -> impl Iterator<Item = (bool, usize)> {
        let (warnings, omission) = (memmem::Finder::new(WARNINGS), memmem::Finder::new(OMISSION));
        self.stages.iter().map(move |stage| {
            let stage = &self.text[stage.clone()];
            (warnings.find(stage).is_some(), omission.find_iter(stage).count())
        })
    }

    /// The record of a stage, as it is written.
    #[must_use]
    pub fn stage(&self, place: usize) -> &'t [u8] {
        &self.text[self.stages[place].clone()]
    }

    fn before(&self) -> usize {
        self.stages.first().map_or(0, |first| first.start)
    }

    fn behind(&self) -> &'t [u8] {
        &self.text[self.stages.last().map_or(0, |last| last.end)..]
    }

    /// The manifest with these stages alone.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn read(&self, places: impl Iterator<Item = usize>) -> Result<Manifest, serde_json::Error> {
        let mut text = self.text[..self.before()].to_vec();
        join(&mut text, places.map(|place| self.stage(place)));
        text.extend_from_slice(self.behind());
        serde_json::from_slice(&text)
    }

    /// The text with what `other` says besides stages, and with its stages in these places; the others were found, and are
    /// unchanged. None where it is not of as many stages.
    ///
    /// # Errors
    /// When it cannot be written as JSON, which cannot be.
    pub fn text_with(&self, other: &Manifest, places: &[usize]) -> Result<Option<Vec<u8>>, serde_json::Error> {
        let other = other.text()?;
        let Some(other) = Cut::of(&other).filter(|other| other.len() == places.len()) else { return Ok(None) };
        let mut text = Vec::with_capacity(self.text.len() + other.text.len());
        text.extend_from_slice(&other.text[..other.schemas]);
        text.extend_from_slice(&self.text[self.schemas..self.before()]);
        let mut others = places.iter().enumerate().peekable();
        let status = memmem::Finder::new(STATUS);
        for place in 0..self.len() {
            if place > 0 {
                text.extend_from_slice(b",\n");
            }
            match others.next_if(|(_, other)| **other == place) {
                Some((of_other, _)) => text.extend_from_slice(other.stage(of_other)),
                None => {
                    let Some([before, behind]) = around_the_status(self.stage(place), &status) else { return Ok(None) };
                    for part in [before, UNCHANGED, behind] {
                        text.extend_from_slice(part);
                    }
                }
            }
        }
        text.extend_from_slice(other.behind());
        Ok(others.next().is_none().then_some(text))
    }

    /// Whether the stages in these places are written as a manifest of them alone would be.
    #[must_use]
    pub fn says(&self, part: &Manifest, places: &[usize]) -> bool {
        let Ok(text) = part.text() else { return false };
        let alike = |part: Cut| {
            part.len() == places.len()
                && places.iter().enumerate().all(|(at, &place)| part.stage(at) == self.stage(place))
        };
        Cut::of(&text).is_some_and(alike)
    }
}

/// What stands in a record before and behind the lines that say what its last run did.
fn around_the_status<'r>(record: &'r [u8], status: &memmem::Finder) -> Option<[&'r [u8]; 2]> {
    let at = status.find(record)?;
    let behind = &record[at + STATUS.len()..];
    let why = behind[memchr::memchr(b'"', behind)?..].strip_prefix(WHY)?;
    // No text in a manifest has a line of its own.
    Some([&record[..at], &why[memchr::memchr(b'\n', why)?..]])
}

fn join<'t>(text: &mut Vec<u8>, stages: impl Iterator<Item = &'t [u8]>) {
    for (place, stage) in stages.enumerate() {
        if place > 0 {
            text.extend_from_slice(b",\n");
        }
        text.extend_from_slice(stage);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::sample;
    use super::*;

    /// A manifest of several stages, as a text and cut.
    fn stages(count: usize) -> Manifest {
        let one = sample();
        let stage = |number: usize| {
            let mut stage = one.stages[0].clone();
            stage.name = format!("m{number}");
            stage
        };
        Manifest { stages: (0..count).map(stage).collect(), ..one }
    }

    #[test]
    fn a_text_is_cut_at_its_stages() {
        for count in 1..4 {
            let manifest = stages(count);
            let text = manifest.text().unwrap();
            let cut = Cut::of(&text).unwrap();
            assert_eq!(cut.len(), count);
            assert_eq!(
                cut.names().collect::<Vec<_>>(),
                ["m0", "m1", "m2"][..count].iter().map(|name| name.as_bytes()).collect::<Vec<_>>()
            );
            assert!(cut.kinds().eq(manifest.stages.iter().map(|stage| stage.kind.as_str())));
            let told = manifest.stages.iter().map(|stage| (!stage.warnings.is_empty(), stage.left_out.len()));
            assert!(cut.told().eq(told));
            assert_eq!(cut.read(0..count).unwrap(), manifest);
            let last = Manifest { stages: vec![manifest.stages[count - 1].clone()], ..manifest.clone() };
            assert_eq!(cut.read([count - 1].into_iter()).unwrap(), last);
            assert!(cut.says(&last, &[count - 1]));
        }
        assert!(Cut::of(b"{}\n").is_none());
        assert!(Cut::of(&stages(0).text().unwrap()).is_none());
        let text = String::from_utf8(stages(2).text().unwrap()).unwrap();
        let compact: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert!(Cut::of(compact.to_string().as_bytes()).is_none(), "of another program");
        assert!(Cut::of(text.replace("\n   \"name\": \"m1\"", "\n   \"kind\": \"m1\"").as_bytes()).is_none());
    }

    #[test]
    fn other_records_in_some_places_are_the_text_of_a_manifest_with_them() {
        let manifest = stages(4);
        let text = manifest.text().unwrap();
        let cut = Cut::of(&text).unwrap();
        let mut whole = Manifest { title: "another".to_owned(), ..manifest.clone() };
        whole.files.truncate(1);
        for (place, stage) in whole.stages.iter_mut().enumerate() {
            let (status, why) = if place % 2 == 1 { ("ran", "config changed") } else { ("hit", "unchanged") };
            (stage.status, stage.why) = (status.to_owned(), why.to_owned());
        }
        let own = Manifest { stages: [1, 3].map(|place| whole.stages[place].clone()).to_vec(), ..whole.clone() };
        assert_eq!(cut.text_with(&own, &[1, 3]).unwrap().unwrap(), whole.text().unwrap());
        assert!(cut.text_with(&own, &[1]).unwrap().is_none());
        assert!(cut.text_with(&own, &[1, 7]).unwrap().is_none());
        assert!(cut.says(&manifest, &[0, 1, 2, 3]) && !cut.says(&whole, &[0, 1, 2, 3]));
    }
}
