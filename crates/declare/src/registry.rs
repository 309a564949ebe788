//! The registry of a family: what is listed is what a user may write.
//!
//! A macro, because a constant list of all members' declarations cannot be made of the list of members by a function.
//! Must not know: what a family is.

/// `registry!(METHODS: Method = energy::Energy, iso6336::Iso6336)`, of declared structs that implement the trait `Method`,
/// makes the list `METHODS`, in the order in which they are listed to the user, `members()` for
/// [`crate::parameter::Shape::Member`], `read(name, record)`, the struct that a decoded record says, and a parameter of
/// `Box<dyn Method>`. `Method` asks its members to be [`crate::declared::Registrable`], which every declared struct is.
#[macro_export]
macro_rules! registry {
    ($list:ident: $family:ident = $($member:path),+ $(,)?) => {
        /// A member as registered.
        #[derive(Clone, Copy)]
        pub struct Registered {
            /// Its declaration: name, meaning and fields.
            pub member: $crate::parameter::Member,
            /// Refuses fields that do not go together.
            pub consistent: fn(&$crate::record::Record) -> Result<(), $crate::error::Diagnostic>,
            /// Itself, as a record that was decoded by `member` says.
            pub read: fn(&$crate::record::Record) -> Box<dyn $family>,
        }

        /// Every member, in the order in which they are listed to the user.
        pub const $list: &[Registered] = &[$(Registered {
            member: <$member as $crate::declared::Declared>::MEMBER,
            consistent: <$member as $crate::declared::Declared>::consistent,
            read: |record| Box::new(<$member as $crate::declared::Declared>::read(record)),
        }),+];

        /// The members as a user may write them.
        #[must_use]
        pub fn members() -> &'static [$crate::parameter::Member] {
            const MEMBERS: &[$crate::parameter::Member] = &[$(<$member as $crate::declared::Declared>::MEMBER),+];
            MEMBERS
        }

        /// The member called `name`, as `record` says.
        ///
        /// # Errors
        /// When there is none of that name.
        pub fn read(
            name: &str,
            record: &$crate::record::Record,
        ) -> Result<Box<dyn $family>, $crate::error::Diagnostic> {
            let found = $list.iter().find(|registered| registered.member.name == name);
            found.map(|registered| (registered.read)(record)).ok_or_else(|| {
                let known = $list.iter().map(|registered| registered.member.name);
                let help = $crate::error::suggest(name, known);
                $crate::error::Diagnostic::new(format!("there is no `{name}`")).at(record.place).help(help)
            })
        }

        impl $crate::declared::Parameter for Box<dyn $family> {
            const SHAPE: $crate::parameter::Shape = $crate::parameter::Shape::Member(members);

            fn consistent(value: &$crate::record::Value) -> Result<(), $crate::error::Diagnostic> {
                let (name, record) = $crate::declared::member(value);
                let found = $list.iter().find(|registered| registered.member.name == name);
                found.map_or(Ok(()), |registered| (registered.consistent)(record))
            }

            fn of_value(value: &$crate::record::Value) -> Self {
                let (name, record) = $crate::declared::member(value);
                read(name, record).unwrap_or_else(|_| $crate::declared::of_another_declaration())
            }

            fn to_value(&self) -> $crate::record::Value {
                $crate::declared::Registrable::member(&**self)
            }
        }
    };
}
