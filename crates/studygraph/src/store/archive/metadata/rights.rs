//! Licences, authors and the paper of a study in the description of an archive.
//!
//! Must not know: stages, files.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::{Author, Description, references};
use crate::store::manifest::Source;

/// The licence of study and results if it is not a single licence of the SPDX list.
const LICENSE: &str = "#license";

/// The address of a paper, if its words contain a DOI or an address.
pub(super) fn address(paper: &str) -> Option<String> {
    let word = |word: &str| {
        let word = word.trim_matches(['<', '>', '(', ')', ',', ';', '.']);
        let doi = word.strip_prefix("doi:").unwrap_or(word);
        let is_doi =
            doi.strip_prefix("10.").and_then(|rest| rest.split_once('/')).is_some_and(|(registrant, suffix)| {
                registrant.len() >= 4 && registrant.starts_with(|c: char| c.is_ascii_digit()) && !suffix.is_empty()
            });
        let is_address =
            ["https://", "http://"].iter().any(|start| word.len() > start.len() && word.starts_with(start));
        let is_plain = word.chars().all(|c| c.is_ascii_graphic() && !"\"<>\\^`{|}".contains(c));
        match (is_plain, is_doi, is_address) {
            (true, true, _) => Some(format!("https://doi.org/{doi}")),
            (true, _, true) => Some(word.to_owned()),
            _ => None,
        }
    };
    paper.split_whitespace().find_map(word)
}

/// The identifier of a paper.
pub(super) fn paper(source: &Source) -> String {
    if let Some(address) = address(&source.paper) {
        return address;
    }
    // Any words may name a paper; an identifier holds none but these.
    let kept = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!("#paper-{}", source.paper.chars().map(kept).collect::<String>())
}

/// The identifier of the licence of study and results.
pub(super) fn license(description: &Description<'_>) -> String {
    match description.license {
        Some(expression) if licenses(expression).eq([expression]) => license_text(expression),
        _ => LICENSE.to_owned(),
    }
}

/// The licences and exceptions of an SPDX expression.
pub(super) fn licenses(expression: &str) -> impl Iterator<Item = &str> {
    let words = expression.split([' ', '(', ')']).map(|word| word.trim_end_matches('+'));
    words.filter(|word| !["", "AND", "OR", "WITH"].contains(word))
}

/// Whether a licence is one of the SPDX list, and not one that only an SPDX document describes.
fn is_listed(spdx: &str) -> bool {
    !["LicenseRef-", "AdditionRef-", "DocumentRef-"].iter().any(|start| spdx.starts_with(start))
}

/// The identifier of a licence: the address of its text if the SPDX list has it.
pub(super) fn license_text(spdx: &str) -> String {
    if is_listed(spdx) { format!("https://spdx.org/licenses/{spdx}") } else { format!("#{spdx}") }
}

pub(super) fn authors<'a>(description: &'a Description<'_>) -> impl Iterator<Item = (String, &'a Author)> {
    description.authors.iter().enumerate().map(|(index, author)| {
        let orcid = author.orcid.as_ref().map(|orcid| format!("https://orcid.org/{orcid}"));
        (orcid.unwrap_or_else(|| format!("#author-{}", index + 1)), author)
    })
}

/// Licences, authors and the paper.
pub(super) fn rights(description: &Description<'_>) -> Vec<Value> {
    let given: BTreeSet<&str> = description.license.iter().flat_map(|expression| licenses(expression)).collect();
    let all: BTreeSet<&str> = licenses(description.about.license).chain(given.iter().copied()).collect();
    let mut entities: Vec<Value> = all
        .into_iter()
        .map(|spdx| {
            let description = if is_listed(spdx) {
                format!("{spdx} of the SPDX list of licences, which has its text.")
            } else {
                format!(
                    "{spdx}, which is not in the SPDX list of licences; its text comes from whoever made this archive."
                )
            };
            json!({
                "@id": license_text(spdx), "@type": "CreativeWork", "name": spdx, "identifier": spdx,
                "description": description,
            })
        })
        .collect();
    if license(description) == LICENSE {
        entities.push(match description.license {
            Some(expression) => json!({
                "@id": LICENSE, "@type": "CreativeWork", "name": expression, "identifier": expression,
                "description": format!("The licence of the study and its results, as an SPDX expression: {expression}."),
                "hasPart": references(given.into_iter().map(license_text)),
            }),
            None => json!({
                "@id": LICENSE, "@type": "CreativeWork", "name": "No licence given",
                "description": "Whoever made this archive gave no licence for the study and its results; all rights \
                                stay with their authors.",
            }),
        });
    }
    entities
        .extend(authors(description).map(|(id, author)| json!({ "@id": id, "@type": "Person", "name": author.name })));
    if let Some(source) = &description.manifest.source {
        let list = |what: &str, numbers: &[i64]| match numbers {
            [] => String::new(),
            numbers => format!(" {what} {}.", numbers.iter().map(i64::to_string).collect::<Vec<_>>().join(", ")),
        };
        let covered = list("Tables", &source.tables) + &list("Figures", &source.figures);
        entities.push(json!({
            "@id": paper(source), "@type": "ScholarlyArticle", "name": source.paper,
            "description": format!("What the study reproduces.{covered}"),
        }));
    }
    entities
}

#[cfg(test)]
mod tests {
    use super::{address, licenses};

    /// DOI Handbook 2.2: a prefix `10.` and a registrant of four digits or more, a slash, a suffix.
    #[test]
    fn the_address_of_a_paper_is_a_doi_or_an_address_in_its_words() {
        for (words, expected) in [
            ("A. Author, 2020, doi:10.1000/182.", Some("https://doi.org/10.1000/182")),
            ("10.1007/s40430-023-04574-3", Some("https://doi.org/10.1007/s40430-023-04574-3")),
            ("see <https://example.org/paper>", Some("https://example.org/paper")),
            ("https://doi.org/10.1000/182", Some("https://doi.org/10.1000/182")),
            ("mei2016", None),
            ("10.5/2 of the book", None),
            ("https://", None),
            ("https://example.org/a\"b", None),
        ] {
            assert_eq!(address(words).as_deref(), expected, "{words}");
        }
        let all: Vec<&str> = licenses("(MIT OR EUPL-1.1+) AND GPL-2.0-only WITH Classpath-exception-2.0").collect();
        assert_eq!(all, ["MIT", "EUPL-1.1", "GPL-2.0-only", "Classpath-exception-2.0"]);
    }
}
