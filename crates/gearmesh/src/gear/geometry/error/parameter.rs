//! What a user states about gears, and what messages call it. Must not know: what is wrong with it.

/// What a user states about gears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// z.
    Teeth,
    /// m.
    Module,
    /// α.
    PressureAngle,
    /// x, in units of the module.
    ProfileShift,
    /// h_aP*.
    RackAddendum,
    /// h_fP*.
    RackDedendum,
    /// ρ_fP*.
    RackTipRadius,
    /// pr*.
    Protuberance,
    /// α_prP.
    ProtuberanceAngle,
    /// q*.
    MachiningAllowance,
    /// ρ_g*.
    NotchRadius,
    /// z_0.
    CutterTeeth,
    /// x_0.
    CutterProfileShift,
    /// h_aP0*.
    CutterAddendum,
    /// ρ_aP0*.
    CutterTipRadius,
    /// r_a.
    TipRadius,
    /// α_KP.
    TipAngle,
    /// b.
    FaceWidth,
    /// Radius of the bore.
    BoreRadius,
    /// E.
    YoungsModulus,
    /// ν.
    PoissonRatio,
    /// a_w.
    CentreDistance,
    /// A_s, W_k or M_dK.
    ToothThickness,
}

impl Parameter {
    /// What messages call it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Teeth => "the number of teeth",
            Self::Module => "the module",
            Self::PressureAngle => "the pressure angle",
            Self::ProfileShift => "the profile shift",
            Self::RackAddendum => "the rack's addendum",
            Self::RackDedendum => "the rack's dedendum",
            Self::RackTipRadius => "the rack's tip radius",
            Self::Protuberance => "the protuberance",
            Self::ProtuberanceAngle => "the angle of the protuberance",
            Self::MachiningAllowance => "the machining allowance",
            Self::NotchRadius => "the radius of the grinding notch",
            Self::CutterTeeth => "the cutter's number of teeth",
            Self::CutterProfileShift => "the cutter's profile shift",
            Self::CutterAddendum => "the cutter's addendum",
            Self::CutterTipRadius => "the cutter's tip radius",
            Self::TipAngle => "the angle of the tip's chamfer",
            Self::TipRadius => "the tip radius",
            Self::FaceWidth => "the face width",
            Self::BoreRadius => "the bore radius",
            Self::YoungsModulus => "Young's modulus",
            Self::PoissonRatio => "Poisson's ratio",
            Self::CentreDistance => "the centre distance",
            Self::ToothThickness => "the tooth thickness",
        }
    }
}
