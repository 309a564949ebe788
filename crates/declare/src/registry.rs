//! The registry of a family whose members are modules: what is listed is what a user may write.
//!
//! A macro, because a constant list of all members' declarations cannot be made of the list of members by a function.
//! Must not know: what a family is.

/// `registry!(Family: one, other)`, where every module has a `FAMILY` with a `member`, makes `FAMILIES`, in the order in
/// which they are listed to the user, `family(name)`, and `members()` for [`crate::parameter::Shape::Member`].
#[macro_export]
macro_rules! registry {
    ($family:ty: $($module:ident),+) => {
        /// Every family, in the order in which they are listed to the user.
        pub const FAMILIES: &[&$family] = &[$(&$module::FAMILY),+];

        /// The family called `name`.
        #[must_use]
        pub fn family(name: &str) -> Option<&'static $family> {
            FAMILIES.iter().copied().find(|family| family.member.name == name)
        }

        /// The families as a user may write them.
        #[must_use]
        pub fn members() -> &'static [$crate::parameter::Member] {
            const MEMBERS: &[$crate::parameter::Member] = &[$($module::FAMILY.member),+];
            MEMBERS
        }
    };
}
