//! What ISO 6336 tells apart of materials, by the abbreviations of ISO 6336-5.
//!
//! Must not know: gears.

use declare::Words;

/// Material and heat treatment of a gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum MaterialClass {
    /// St: normalized low carbon steel or cast steel
    StructuralSteel,
    /// V: through-hardened steel, carbon or alloy
    ThroughHardenedSteel,
    /// Eh: case-hardened steel
    CaseHardenedSteel,
    /// IF: flame or induction hardened steel, with a hardened root
    SurfaceHardenedSteel,
    /// NT or NV (nitr.): nitrided steel
    NitridedSteel,
    /// NV (nitrocar.): nitrocarburized steel
    NitrocarburizedSteel,
    /// GG: grey cast iron
    GreyCastIron,
    /// GGG (ferr.): nodular cast iron of ferritic structure
    FerriticNodularIron,
    /// GGG (perl., bai.): nodular cast iron of pearlitic or bainitic structure
    PearliticNodularIron,
    /// GTS (perl.): black malleable cast iron of pearlitic structure
    MalleableIron,
}

/// How a material behaves where only three kinds are told apart: as it runs in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// St, V, GGG (perl., bai.), GTS: wears in more, the softer it is.
    Soft,
    /// GG, GGG (ferr.).
    CastIron,
    /// Eh, IF, NT, NV.
    Hard,
}

impl MaterialClass {
    /// Which of the three.
    #[must_use]
    pub const fn surface(self) -> Surface {
        match self {
            Self::StructuralSteel | Self::ThroughHardenedSteel | Self::PearliticNodularIron | Self::MalleableIron => {
                Surface::Soft
            }
            Self::GreyCastIron | Self::FerriticNodularIron => Surface::CastIron,
            Self::CaseHardenedSteel | Self::SurfaceHardenedSteel | Self::NitridedSteel | Self::NitrocarburizedSteel => {
                Surface::Hard
            }
        }
    }
}
