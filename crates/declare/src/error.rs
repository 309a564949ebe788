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

/// The known name nearest to `name`, when it is near enough to be a likely slip.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best: Option<(f64, &str)> = None;
    for candidate in known {
        let likeness = strsim::normalized_damerau_levenshtein(name, candidate).max(
            // A name that is a word of a longer one (`addendum` of `addendum_coefficient`) is a likely slip too.
            if !name.is_empty() && candidate.split('_').any(|word| word == name) { 0.7 } else { 0.0 },
        );
        if likeness >= 0.5 && best.is_none_or(|(so_far, _)| likeness > so_far) {
            best = Some((likeness, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Names that a message lists at most.
const MOST_NAMES: usize = 30;

/// `did you mean …`, or the list of what is known.
#[must_use]
pub fn suggest<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    if let Some(candidate) = nearest(name, known.clone()) {
        return format!("did you mean `{candidate}`?");
    }
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
