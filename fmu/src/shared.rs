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
                Instance::call(instance, stringify!($reset), &ANY, |own| {
                    own.unit.reset();
                    own.phase = Phase::Instantiated;
                    Ok(())
                })
            }
        }

        /// Hands out a copy of the state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(instance: *mut Instance, state: *mut *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($get), &ANY, |own| own.save(state)) }
        }

        /// Back into a state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(instance: *mut Instance, state: *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($set), &ANY, |own| own.restore(state)) }
        }

        /// Frees a state.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $free_state(instance: *mut Instance, state: *mut *mut Saved) -> Status {
            unsafe { Instance::call(instance, stringify!($free_state), &ANY, |own| own.forget(state)) }
        }

        /// Bytes that a state takes.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $size(
            instance: *mut Instance,
            state: *mut Saved,
            size: *mut usize,
        ) -> Status {
            unsafe {
                Instance::call(instance, stringify!($size), &ANY, |own| {
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
                Instance::call(instance, stringify!($serialize), &ANY, |own| {
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
                Instance::call(instance, stringify!($deserialize), &ANY, |own| {
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

/// Functions for what the unit does not have: they are there, and refuse. Arguments besides the instance are not read.
macro_rules! refused {
    ($($name:ident,)*) => {$(
        /// For what the unit does not have: refuses.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut Instance) -> Status {
            unsafe {
                Instance::call(instance, stringify!($name), &ANY, |_| {
                    Err(Refusal::Error("the unit does not have this".into()))
                })
            }
        }
    )*};
}
pub(crate) use refused;
