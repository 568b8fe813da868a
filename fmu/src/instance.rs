//! An instance behind the C interfaces: order of the calls, log, states that were handed out.

use crate::source::UnitSource;
use crate::unit::{ImpactUnit, Refusal, UnitState};
use crate::variables::Type;
use serde::{Deserialize, Serialize};
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::ptr;

/// What a call comes to; FMI 2.0 and 3.0 number them alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// Done.
    Ok,
    /// Done, with something to know.
    Warning,
    /// Not carried out; the instance is as before.
    Discard,
    /// Wrong call.
    Error,
    /// The instance can't be used any more.
    Fatal,
}

/// Categories of the log, as `modelDescription.xml` lists them.
pub const CATEGORIES: [(&str, &str); 2] = [
    ("logStatusError", "Calls that are refused"),
    ("logStatusWarning", "Warnings of an impact, launches that are ignored"),
];

/// Where an instance is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Made, not begun.
    Instantiated,
    /// Parameters and inputs take their first values.
    Initialization,
    /// Steps.
    Step,
    /// After the last step.
    Terminated,
    /// After a fault of the unit itself: it can only be freed.
    Failed,
}

impl Phase {
    /// All but after a fault.
    pub const ANY: [Self; 4] = [Self::Instantiated, Self::Initialization, Self::Step, Self::Terminated];
    /// Those in which variables can be set.
    pub const SETTABLE: [Self; 3] = [Self::Instantiated, Self::Initialization, Self::Step];
}

/// Function of the environment that takes log messages.
#[derive(Debug, Clone, Copy)]
pub enum Logger {
    /// None is given.
    Silent,
    /// Of FMI 2.0.
    Two(LogMessage2),
    /// Of FMI 3.0.
    Three(LogMessage3),
}

/// `fmi2CallbackLogger`: environment, name of the instance, status, category, message (a format string), its arguments.
pub type LogMessage2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);
/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessage3 = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// Who wants to know what.
#[derive(Debug)]
pub struct InstanceLog {
    /// Name of the instance.
    pub name: CString,
    /// Takes the messages.
    pub logger: Logger,
    /// The environment's own pointer.
    pub environment: *mut c_void,
    /// Whether it wants more than errors.
    pub is_on: bool,
}

impl InstanceLog {
    /// Passes on what the user has to know.
    pub fn remark(&self, remarks: &[String]) {
        remarks.iter().for_each(|remark| self.write(Status::Warning, remark));
    }

    /// Passes `message` on.
    pub fn write(&self, status: Status, message: &str) {
        let is_error = matches!(status, Status::Error | Status::Fatal | Status::Discard);
        if !is_error && !self.is_on {
            return;
        }
        let category = if is_error { c"logStatusError" } else { c"logStatusWarning" };
        let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
        match self.logger {
            Logger::Silent => {}
            // SAFETY: the environment promises a function of this type for the life of the instance
            Logger::Two(log) => unsafe {
                log(
                    self.environment,
                    self.name.as_ptr(),
                    status,
                    category.as_ptr(),
                    c"%s".as_ptr(),
                    message.as_ptr(),
                );
            },
            // SAFETY: as above
            Logger::Three(log) => unsafe {
                log(self.environment, status, category.as_ptr(), message.as_ptr());
            },
        }
    }
}

/// A unit in a simulation.
#[derive(Debug)]
pub struct Instance {
    /// The unit.
    pub unit: ImpactUnit,
    /// Its log.
    pub log: InstanceLog,
    /// Where it is in its life.
    pub phase: Phase,
    /// Whether a step may end before its end.
    pub may_stop: bool,
    /// States that were handed out and not freed yet.
    #[expect(clippy::vec_box, reason = "the environment keeps their addresses")]
    states: Vec<Box<Saved>>,
}

/// A state that was handed out.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Saved {
    phase: Phase,
    state: UnitState,
}

impl Instance {
    /// Makes one of the unit in the folder `resources` if its token is `token`; a null pointer with a message in the log if that fails.
    pub fn create(log: InstanceLog, token: &CStr, resources: &Path, may_stop: bool) -> *mut Self {
        let made = catch_unwind(|| {
            let source = UnitSource::read(resources).map_err(|error| error.to_string())?;
            let own = source.setup.token.clone();
            if token.to_bytes() != own.as_bytes() {
                let given = token.to_string_lossy();
                return Err(format!(
                    "the instantiation token is \"{given}\", but that of the unit is \"{own}\""
                ));
            }
            ImpactUnit::new(source).map_err(|error| error.to_string())
        });
        match made {
            Ok(Ok(unit)) => Box::into_raw(Box::new(Self {
                unit,
                log,
                phase: Phase::Instantiated,
                may_stop,
                states: Vec::new(),
            })),
            Ok(Err(reason)) => {
                log.write(Status::Error, &reason);
                ptr::null_mut()
            }
            Err(_) => {
                log.write(Status::Fatal, "the unit has a fault");
                ptr::null_mut()
            }
        }
    }

    /// Ends an instance with all states that it has handed out; nothing of a null pointer.
    ///
    /// # Safety
    /// `instance` is null or comes from [`Instance::create`] and is not used any more.
    pub unsafe fn free(instance: *mut Self) {
        if !instance.is_null() {
            // SAFETY: by the caller
            drop(unsafe { Box::from_raw(instance) });
        }
    }

    /// Carries out `call` named `name` if the instance is in one of `phases`; what it refuses is logged.
    ///
    /// # Safety
    /// `instance` is null or comes from [`Instance::create`] and is not freed; no other call runs on it.
    pub unsafe fn call(
        instance: *mut Self,
        name: &str,
        phases: &[Phase],
        call: impl FnOnce(&mut Self) -> Result<(), Refusal>,
    ) -> Status {
        // SAFETY: by the caller
        let Some(instance) = (unsafe { instance.as_mut() }) else { return Status::Error };
        if !phases.contains(&instance.phase) {
            let message = format!("{name}: not allowed in the phase {:?}", instance.phase);
            instance.log.write(Status::Error, &message);
            return Status::Error;
        }
        let (status, reason) = match catch_unwind(AssertUnwindSafe(|| call(instance))) {
            Ok(Ok(())) => return Status::Ok,
            Ok(Err(Refusal::Discard(reason))) => (Status::Discard, reason),
            Ok(Err(Refusal::Error(reason))) => (Status::Error, reason),
            Err(_) => {
                instance.phase = Phase::Failed;
                (Status::Fatal, "the unit has a fault".into())
            }
        };
        instance.log.write(status, &format!("{name}: {reason}"));
        status
    }

    /// Copies the value of every variable in `references` into `values`.
    ///
    /// # Errors
    /// As [`ImpactUnit::get`].
    ///
    /// # Safety
    /// `references` and `values` point to `count` entries each.
    pub unsafe fn get<T>(
        &self,
        (references, values, count): (*const u32, *mut T, usize),
        kind: Type,
        convert: impl Fn(f64) -> T,
    ) -> Result<(), Refusal> {
        for k in 0..count {
            // SAFETY: by the caller
            unsafe { values.add(k).write(convert(self.unit.get(*references.add(k), kind)?)) };
        }
        Ok(())
    }

    /// Sets every variable in `references` to its entry of `values`: all or none.
    ///
    /// # Errors
    /// As [`ImpactUnit::set`].
    ///
    /// # Safety
    /// As [`Instance::get`].
    pub unsafe fn set<T: Copy>(
        &mut self,
        (references, values, count): (*const u32, *const T, usize),
        kind: Type,
        convert: impl Fn(T) -> f64,
    ) -> Result<(), Refusal> {
        let before = self.unit.state().clone();
        for k in 0..count {
            // SAFETY: by the caller
            let (reference, value) = unsafe { (*references.add(k), *values.add(k)) };
            if let Err(refusal) = self.unit.set(reference, kind, convert(value)) {
                self.unit.set_state(before)?;
                return Err(refusal);
            }
        }
        Ok(())
    }

    /// Puts a copy of the state into `place`, which is null or holds a state to overwrite.
    ///
    /// # Errors
    /// [`Refusal::Error`] if it holds something else.
    ///
    /// # Safety
    /// `place` points to a pointer.
    pub unsafe fn save(&mut self, place: *mut *mut Saved) -> Result<(), Refusal> {
        // SAFETY: by the caller
        let place = given(unsafe { place.as_mut() })?;
        let state = Saved { phase: self.phase, state: self.unit.state().clone() };
        if place.is_null() {
            *place = self.hand_out(state);
        } else {
            *self.known(*place)? = state;
        }
        Ok(())
    }

    /// Puts a state into the hands of the environment, by its address.
    pub fn hand_out(&mut self, state: Saved) -> *mut Saved {
        let mut state = Box::new(state);
        let address: *mut Saved = &mut *state;
        self.states.push(state);
        address
    }

    /// The state at an address that this instance has handed out.
    ///
    /// # Errors
    /// [`Refusal::Error`] of any other address.
    pub fn known(&mut self, state: *mut Saved) -> Result<&mut Saved, Refusal> {
        let known = self.states.iter_mut().find(|known| ptr::eq::<Saved>(&***known, state));
        known
            .map(|known| &mut **known)
            .ok_or_else(|| Refusal::Error("the state is none that this instance has given".into()))
    }

    /// Back into a state that this instance has handed out.
    ///
    /// # Errors
    /// [`Refusal::Error`] of any other pointer.
    pub fn restore(&mut self, state: *mut Saved) -> Result<(), Refusal> {
        let Saved { phase, state } = self.known(state)?.clone();
        self.unit.set_state(state)?;
        self.phase = phase;
        Ok(())
    }

    /// Frees a state that this instance has handed out, and sets the pointer to null.
    ///
    /// # Errors
    /// [`Refusal::Error`] of any other pointer.
    ///
    /// # Safety
    /// `place` is null or points to a pointer.
    pub unsafe fn forget(&mut self, place: *mut *mut Saved) -> Result<(), Refusal> {
        // SAFETY: by the caller
        let Some(place) = (unsafe { place.as_mut() }).filter(|place| !place.is_null()) else { return Ok(()) };
        self.known(*place)?;
        self.states.retain(|known| !ptr::eq::<Saved>(&**known, *place));
        *place = ptr::null_mut();
        Ok(())
    }

    /// A state as bytes that another instance of the same unit reads.
    ///
    /// # Errors
    /// [`Refusal::Error`] of a pointer to anything else.
    pub fn serialized(&mut self, state: *mut Saved) -> Result<Vec<u8>, Refusal> {
        serde_json::to_vec(self.known(state)?).map_err(|error| Refusal::Error(error.to_string()))
    }

    /// The state that `bytes` hold.
    ///
    /// # Errors
    /// [`Refusal::Error`] if they hold none.
    pub fn deserialized(&mut self, bytes: &[u8]) -> Result<*mut Saved, Refusal> {
        let state = serde_json::from_slice(bytes)
            .map_err(|error| Refusal::Error(format!("the bytes are no state of a unit: {error}")))?;
        Ok(self.hand_out(state))
    }

    /// Turns the log on or off.
    ///
    /// # Errors
    /// [`Refusal::Error`] of a category that there is not.
    ///
    /// # Safety
    /// `categories` points to `count` texts.
    pub unsafe fn set_log(
        &mut self,
        is_on: bool,
        categories: *const *const c_char,
        count: usize,
    ) -> Result<(), Refusal> {
        for k in 0..count {
            // SAFETY: by the caller
            let category = unsafe { text(*categories.add(k)) }.to_string_lossy();
            if !CATEGORIES.iter().any(|(name, _)| *name == category) {
                return Err(Refusal::Error(format!("there is no log category \"{category}\"")));
            }
        }
        self.log.is_on = is_on;
        Ok(())
    }
}

/// Where a result goes.
///
/// # Errors
/// [`Refusal::Error`] of a null pointer.
pub fn given<T>(place: Option<&mut T>) -> Result<&mut T, Refusal> {
    place.ok_or_else(|| Refusal::Error("there is no place for the result: a pointer is null".into()))
}

/// The text at `pointer`; an empty one for null.
///
/// # Safety
/// `pointer` is null or points to a text that ends with 0 and lives as long as the result is used.
pub unsafe fn text<'a>(pointer: *const c_char) -> &'a CStr {
    // SAFETY: by the caller
    if pointer.is_null() { c"" } else { unsafe { CStr::from_ptr(pointer) } }
}
