//! The functions that both C interfaces have under names of their own.

/// Life and states of an instance.
macro_rules! life {
    (
        free: $free:ident,
        exit_initialization: $exit:ident,
        terminate: $terminate:ident,
        reset: $reset:ident,
        get_state: $get:ident,
        set_state: $set:ident,
        free_state: $free_state:ident,
        size_of_state: $size:ident,
        serialize: $serialize:ident,
        deserialize: $deserialize:ident,
    ) => {
        /// Ends an instance.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $free(instance: *mut Instance) {
            unsafe { Instance::free(instance) };
        }

        /// Ends the initialization; a launch that is set begins.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $exit(instance: *mut Instance) -> Status {
            unsafe {
                Instance::call(instance, stringify!($exit), &[Phase::Initialization], |own| {
                    let remarks = own.unit.start()?;
                    own.log.remark(&remarks);
                    own.phase = Phase::Step;
                    Ok(())
                })
            }
        }

        /// Ends the simulation.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $terminate(instance: *mut Instance) -> Status {
            unsafe {
                Instance::call(instance, stringify!($terminate), &[Phase::Step], |own| {
                    own.phase = Phase::Terminated;
                    Ok(())
                })
            }
        }

        /// Back to the state after the instantiation.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $reset(instance: *mut Instance) -> Status {
            unsafe {
                Instance::call(instance, stringify!($reset), &Phase::ANY, |own| {
                    own.unit.reset();
                    own.phase = Phase::Instantiated;
                    Ok(())
                })
            }
        }

        /// Hands out a copy of the state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(instance: *mut Instance, state: *mut *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($get), &Phase::ANY, |own| own.save(state)) }
        }

        /// Back into a state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(instance: *mut Instance, state: *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($set), &Phase::ANY, |own| own.restore(state)) }
        }

        /// Frees a state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $free_state(instance: *mut Instance, state: *mut *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($free_state), &Phase::ANY, |own| own.forget(state)) }
        }

        /// Bytes that a state takes.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $size(
            instance: *mut Instance,
            state: *mut Saved,
            size: *mut usize,
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($size), &Phase::ANY, |own| {
                    let length = own.serialized(state)?.len();
                    *given(size.as_mut())? = length;
                    Ok(())
                })
            }
        }

        /// Writes a state as bytes.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $serialize(
            instance: *mut Instance,
            state: *mut Saved,
            bytes: *mut u8,
            size: usize,
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($serialize), &Phase::ANY, |own| {
                    let found = own.serialized(state)?;
                    if found.len() > size {
                        let needed = found.len();
                        return Err(Refusal::Error(format!(
                            "the state takes {needed} bytes, there are {size}"
                        )));
                    }
                    ptr::copy_nonoverlapping(found.as_ptr(), given(bytes.as_mut())?, found.len());
                    Ok(())
                })
            }
        }

        /// Reads a state from bytes.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $deserialize(
            instance: *mut Instance,
            bytes: *const u8,
            size: usize,
            state: *mut *mut Saved,
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($deserialize), &Phase::ANY, |own| {
                    let place = given(state.as_mut())?;
                    let bytes = if bytes.is_null() { &[][..] } else { slice::from_raw_parts(bytes, size) };
                    *place = own.deserialized(bytes)?;
                    Ok(())
                })
            }
        }
    };
}
pub(crate) use life;

/// Functions that get and set the values of each type of variable. The name in brackets is that of the number of values, an argument of
/// FMI 3.0 alone.
macro_rules! values {
    ($counted:tt $($kind:ident: $value:ty, $get:ident, $set:ident, $out:expr, $into:expr;)*) => {$(
        $crate::shared::values_of_type!{ $counted $kind: $value, $get, $set, $out, $into }
    )*};
}
pub(crate) use values;

macro_rules! values_of_type {
    ([$($counted:ident)?] $kind:ident: $value:ty, $get:ident, $set:ident, $out:expr, $into:expr) => {
        /// Values of variables of a type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: *mut Instance,
            references: *const u32,
            count: usize,
            values: *mut $value,
            $($counted: usize,)?
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($get), &Phase::ANY, |own| {
                    $(of_same_length(count, $counted)?;)?
                    own.get((references, values, count), Type::$kind, $out)
                })
            }
        }

        /// Sets variables of a type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: *mut Instance,
            references: *const u32,
            count: usize,
            values: *const $value,
            $($counted: usize,)?
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($set), &Phase::SETTABLE, |own| {
                    $(of_same_length(count, $counted)?;)?
                    own.set((references, values, count), Type::$kind, $into)
                })
            }
        }
    };
}
pub(crate) use values_of_type;

/// Functions for what the unit does not have: they are there, and refuse. Arguments besides the instance are not read.
macro_rules! refused {
    ($($name:ident,)*) => {$(
        /// For what the unit does not have: refuses.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut Instance) -> Status {
            unsafe {
                Instance::call(instance, stringify!($name), &Phase::ANY, |_| {
                    Err(Refusal::Error("the unit does not have this".into()))
                })
            }
        }
    )*};
}
pub(crate) use refused;
