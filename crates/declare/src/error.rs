//! Errors that a user reads: one clear message, the place in the study it is about, and what to do.
//!
//! Must not know: how a message is drawn (that is the command line's business) or which file a place is in.

/// A place in a study's text. Lines and columns count from 1, columns in characters; `offset` and `length` count bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    pub line: usize,
    pub column: usize,
    pub offset: usize,
    pub length: usize,
}

/// What is wrong with what somebody stated, found before anything is computed. Of a study it ends the program with code 2.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}{}", .help.as_ref().map_or_else(String::new, |help| format!("; {help}")))]
pub struct Diagnostic {
    /// One sentence: what was found and what was expected.
    pub message: String,
    /// Where; `None` only when the whole file is meant.
    pub place: Option<Place>,
    /// The field that is meant, where whoever found it knows no places.
    pub field: Option<&'static str>,
    /// Which item of that field's list, from 0.
    pub item: Option<u32>,
    /// What to write instead.
    pub help: Option<String>,
}

impl Diagnostic {
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, field: None, item: None, help: None }
    }

    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// Sets the place unless one is known already: the innermost place is the most telling.
    #[must_use]
    pub fn or_at(mut self, place: Place) -> Self {
        self.place.get_or_insert(place);
        self
    }

    /// About a field, called by its name.
    #[must_use]
    pub fn of(mut self, field: &'static str) -> Self {
        self.field = Some(field);
        self
    }

    /// About an item of a field's list, counted from 0.
    #[must_use]
    pub fn of_item(self, field: &'static str, item: usize) -> Self {
        // No list of a study is longer, and results with a message in them stay small.
        Self { item: u32::try_from(item).ok(), ..self.of(field) }
    }

    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// What is wrong with something that was stated: one thing, and whatever else was found with it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{first}")]
pub struct Faults {
    pub first: Box<Diagnostic>,
    pub others: Vec<Diagnostic>,
}

impl From<Diagnostic> for Faults {
    fn from(first: Diagnostic) -> Self {
        Self { first: Box::new(first), others: Vec::new() }
    }
}

impl Faults {
    /// Nothing, or all of them.
    ///
    /// # Errors
    /// When something was found.
    pub fn all(found: Vec<Diagnostic>) -> Result<(), Self> {
        let mut found = found.into_iter();
        match found.next() {
            Some(first) => Err(Self { first: Box::new(first), others: found.collect() }),
            None => Ok(()),
        }
    }

    /// What each gave, or everything that is wrong with any.
    ///
    /// # Errors
    /// When anything was wrong.
    pub fn collect<T, E: Into<Self>>(each: impl IntoIterator<Item = Result<T, E>>) -> Result<Vec<T>, Self> {
        let (given, wrong) = Self::apart(each);
        Self::all(wrong).map(|()| given)
    }

    /// What each gave with which nothing is wrong, and everything that is wrong with the others.
    pub fn apart<T, E: Into<Self>>(each: impl IntoIterator<Item = Result<T, E>>) -> (Vec<T>, Vec<Diagnostic>) {
        let (mut given, mut wrong) = (Vec::new(), Vec::new());
        for one in each {
            match one {
                Ok(one) => given.push(one),
                Err(found) => wrong.extend(found.into()),
            }
        }
        (given, wrong)
    }
}

impl IntoIterator for Faults {
    type Item = Diagnostic;
    type IntoIter = std::iter::Chain<std::iter::Once<Diagnostic>, std::vec::IntoIter<Diagnostic>>;

    fn into_iter(self) -> Self::IntoIter {
        std::iter::once(*self.first).chain(self.others)
    }
}

/// Why a stage that ran could not give its tables (exit code 3).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The stage's own finding: the message says what, with the values and the admissible range.
    #[error("{0}")]
    Failed(String),
    /// The same about places in the study, which no check could find before it ran.
    #[error("{0}")]
    Study(Faults),
    /// The user asked to stop; nothing of this stage is kept.
    #[error("stopped before it finished")]
    Stopped,
}

impl Failure {
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self::Failed(message.into())
    }

    /// What is wrong with the study, where its place is known: what comes from a table has none.
    #[must_use]
    pub fn of(wrong: Diagnostic) -> Self {
        let is_known = wrong.place.is_some_and(|place| place != Place::default());
        if is_known { Self::Study(wrong.into()) } else { Self::Failed(wrong.message) }
    }
}

impl From<Faults> for Failure {
    fn from(wrong: Faults) -> Self {
        Self::Study(wrong)
    }
}

/// The known name nearest to `name`, when it is near enough to be a likely slip of the pen.
///
/// A name says what its words say: one with a word that the candidate lacks means something else (`gear_torque` is no slip of
/// `torque`), and so does one with another number or an opposite word. Words of the candidate may be left out.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best: Option<(f64, &str)> = None;
    let mut with_word = 0;
    for candidate in known {
        let is_word = is_word_of(name, candidate);
        with_word += usize::from(is_word);
        let likeness = strsim::normalized_damerau_levenshtein(name, candidate).max(
            // A name that is a word of a longer one (`addendum` of `addendum_coefficient`) is a likely slip too.
            if is_word { WORD_LIKENESS } else { 0.0 },
        );
        if likeness >= 0.5 && best.is_none_or(|(so_far, _)| likeness > so_far) && may_mean(name, candidate) {
            best = Some((likeness, candidate));
        }
    }
    // `crowning` is as much of `profile_crowning` as of `lead_crowning`: which one is meant is not for a message to say.
    best.filter(|(likeness, _)| with_word < 2 || *likeness > WORD_LIKENESS).map(|(_, candidate)| candidate)
}

/// Likeness of a name to a longer one of which it is a word.
const WORD_LIKENESS: f64 = 0.7;

fn is_word_of(name: &str, candidate: &str) -> bool {
    !name.is_empty() && candidate != name && candidate.split('_').any(|word| word == name)
}

/// Words that are alike and mean the opposite of each other.
const OPPOSITES: &[[&str; 2]] = &[
    ["minimum", "maximum"],
    ["min", "max"],
    ["least", "largest"],
    ["inner", "outer"],
    ["input", "output"],
    ["driver", "driven"],
    ["driving", "driven"],
    ["upper", "lower"],
    ["before", "after"],
    ["radius", "radial"],
    ["tip", "top"],
];

/// Whether `name` may be a slip for `candidate`: every word of it is one of the candidate's, but for a slip.
fn may_mean(name: &str, candidate: &str) -> bool {
    let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
    if digits(name) != digits(candidate) {
        return false;
    }
    let joined =
        |text: &str| text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect::<String>();
    let (whole, other) = (joined(name), joined(candidate));
    let (words, others) = (words(name), words(candidate));
    let is_opposite = |one: &str, two: &str| OPPOSITES.contains(&[one, two]) || OPPOSITES.contains(&[two, one]);
    if words.iter().any(|word| !others.contains(word) && others.iter().any(|other| is_opposite(word, other))) {
        return false;
    }
    // One short word for another one.
    if words.len() == 1 && others.len() == 1 && other.len() < 6 {
        return strsim::damerau_levenshtein(&whole, &other) <= 2;
    }
    // Words run together, or divided elsewhere.
    if strsim::damerau_levenshtein(&whole, &other) <= slips(other.len()).min(1) {
        return true;
    }
    // A whole name with something before or behind it.
    if other.len() > 2 && whole.contains(&other) && whole.len() >= other.len() + 3 {
        return false;
    }
    let is_there = |word: &String| others.iter().any(|other| word == other || is_slip(word, other));
    words.iter().all(is_there)
}

/// Letters that a slip of a word of so many may have.
fn slips(length: usize) -> usize {
    match length {
        0..=1 => 0,
        2..=5 => 1,
        6..=7 => 2,
        _ => length / 4,
    }
}

fn is_slip(word: &str, other: &str) -> bool {
    let longest = word.chars().count().max(other.chars().count());
    // A whole word with another one behind it.
    if other.len() > 2 && word.contains(other) && word.len() >= other.len() + 3 {
        return false;
    }
    let is_abbreviation = word.len() >= 3 && other.starts_with(word);
    is_abbreviation || strsim::damerau_levenshtein(word, other) <= slips(longest)
}

/// The words of a name, in small letters: `faceWidth`, `face-width` and `face_width` have two.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut was_small = false;
    for letter in name.chars() {
        let is_new = !letter.is_alphanumeric() || (letter.is_uppercase() && was_small);
        if is_new {
            words.push(String::new());
        }
        was_small = letter.is_lowercase();
        if letter.is_alphanumeric() {
            words.last_mut().into_iter().for_each(|word| word.extend(letter.to_lowercase()));
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Names that a message lists at most.
const MOST_NAMES: usize = 30;

/// The same for a name that a field has elsewhere, which is no slip of the pen for other words: `angle` may stand for
/// `pressure_angle`, `step` for `steps`; `load` stands neither for `law` nor for `load_factor`.
#[must_use]
pub fn suggest_for_field<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let is_same = |candidate: &&str| {
        let head = candidate.strip_suffix(name).is_some_and(|before| before.ends_with('_'));
        let [short, long] = if name.len() < candidate.len() { [name, candidate] } else { [candidate, name] };
        head || long.strip_suffix('s') == Some(short)
    };
    let same: Vec<&str> = known.clone().into_iter().filter(is_same).collect();
    if same.is_empty() { known_here(known) } else { suggest(name, same) }
}

/// `did you mean …`, or the list of what is known.
#[must_use]
pub fn suggest<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    if let Some(candidate) = nearest(name, known.clone()) {
        return format!("did you mean `{candidate}`?");
    }
    let with_word: Vec<_> = known.clone().into_iter().filter(|candidate| is_word_of(name, candidate)).collect();
    if let [others @ .., last] = &with_word[..]
        && !others.is_empty()
    {
        let others: Vec<_> = others.iter().map(|name| format!("`{name}`")).collect();
        return format!("did you mean {} or `{last}`?", others.join(", "));
    }
    known_here(known)
}

fn known_here<'a>(known: impl IntoIterator<Item = &'a str>) -> String {
    let mut names: Vec<_> = known.into_iter().map(|name| format!("`{name}`")).collect();
    if names.is_empty() {
        return "there are none to choose from".to_owned();
    }
    if names.len() > MOST_NAMES {
        let more = names.len() - MOST_NAMES;
        names.truncate(MOST_NAMES);
        names.push(format!("and {more} more"));
    }
    format!("known here: {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_pen_are_found() {
        for (name, known) in [
            ("facewidth", "face_width"),
            ("faceWidth", "face_width"),
            ("Face-Width", "face_width"),
            ("face_with", "face_width"),
            ("preasure_angle", "pressure_angle"),
            ("torqe", "torque"),
            ("tooth", "teeth"),
            ("pear", "pair"),
            ("nn", "nm"),
            ("ammount", "amount"),
            ("profile_shfit", "profile_shift"),
            ("addendum", "addendum_coefficient"),
        ] {
            assert_eq!(nearest(name, ["bore", known, "other"]), Some(known), "{name}");
        }
    }

    /// Tier: invariant; a name with one word more, another number or an opposite word means something else.
    #[test]
    fn no_name_is_offered_across_a_change_of_meaning() {
        for (name, known) in [
            ("gear_torque", "torque"),
            ("torque_gear", "torque"),
            ("geartorque", "torque"),
            ("gearTorque", "torque"),
            ("torque2", "torque"),
            ("torque_2", "torque_1"),
            ("min_torque", "max_torque"),
            ("minimum", "maximum"),
            ("base_radius", "bore_radius"),
            ("root_radius", "tip_radius"),
            ("driven_torque", "driving_torque"),
            ("input_speed", "output_speed"),
            ("tip_relief", "root_relief"),
            ("left_flank", "flank"),
            ("ringpair", "pair"),
            ("crossover_inner", "crossover_index"),
        ] {
            assert_eq!(nearest(name, [known]), None, "{name}");
        }
        let crowned = ["profile_crowning", "lead_crowning", "arc"];
        assert_eq!(nearest("crowning", crowned), None);
        assert_eq!(suggest("crowning", crowned), "did you mean `profile_crowning` or `lead_crowning`?");
    }
}
