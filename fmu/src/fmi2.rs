//! The C interface of FMI 2.0, co-simulation (`fmi2Functions.h`).
//!
//! # Safety
//! As [`crate::fmi3`].
#![expect(clippy::missing_safety_doc, reason = "the standard states how these functions are called")]

use crate::instance::{Instance, InstanceLog, LogMessage2, Logger, Phase, Saved, Status, given, text};
use crate::shared::{life, refused, values};
use crate::unit::Refusal;
use crate::variables::Type;
use std::ffi::{c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr;
use std::slice;

/// `fmi2Boolean`.
pub type Boolean2 = c_int;
/// `fmi2CoSimulation`.
const CO_SIMULATION: c_int = 1;
/// `fmi2LastSuccessfulTime`.
const LAST_SUCCESSFUL_TIME: c_int = 2;

/// `fmi2CallbackFunctions`.
#[derive(Debug)]
#[repr(C)]
pub struct Callbacks {
    logger: Option<LogMessage2>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2GetTypesPlatform`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// `fmi2GetVersion`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    resources: *const c_char,
    functions: *const Callbacks,
    _visible: Boolean2,
    logging_on: Boolean2,
) -> *mut Instance {
    let functions = unsafe { functions.as_ref() };
    let log = InstanceLog {
        name: unsafe { text(name) }.to_owned(),
        logger: functions.and_then(|of| of.logger).map_or(Logger::Silent, Logger::Two),
        environment: functions.map_or(ptr::null_mut(), |of| of.environment),
        is_on: logging_on != 0,
    };
    if kind != CO_SIMULATION {
        log.write(Status::Error, "the unit is for co-simulation only");
        return ptr::null_mut();
    }
    let (token, resources) = unsafe { (text(token), text(resources)) };
    Instance::create(log, token, &path_of(&resources.to_string_lossy()), false)
}

/// The path behind a URI such as `file:///units/my%20unit/resources`, with or without host.
fn path_of(uri: &str) -> PathBuf {
    let local = uri.get(..5).filter(|scheme| scheme.eq_ignore_ascii_case("file:")).map_or(uri, |_| &uri[5..]);
    let path = local.strip_prefix("//").map_or(local, |rest| &rest[rest.find('/').unwrap_or(0)..]);
    // "/C:/..." of Windows
    let path = if path.as_bytes().get(2) == Some(&b':') { path.trim_start_matches('/') } else { path };
    let (mut bytes, mut rest) = (Vec::new(), path.as_bytes());
    while let [first, tail @ ..] = rest {
        let escaped = (*first == b'%').then(|| tail.get(..2)).flatten();
        let escaped = escaped.and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8_lossy(&bytes).into_owned().into()
}

life! {
    free: fmi2FreeInstance,
    exit_initialization: fmi2ExitInitializationMode,
    terminate: fmi2Terminate,
    reset: fmi2Reset,
    get_state: fmi2GetFMUstate,
    set_state: fmi2SetFMUstate,
    free_state: fmi2FreeFMUstate,
    size_of_state: fmi2SerializedFMUstateSize,
    serialize: fmi2SerializeFMUstate,
    deserialize: fmi2DeSerializeFMUstate,
}

/// `fmi2SetDebugLogging`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    instance: *mut Instance,
    on: Boolean2,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi2SetDebugLogging", &Phase::ANY, |own| {
            own.set_log(on != 0, categories, count)
        })
    }
}

/// `fmi2SetupExperiment`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    instance: *mut Instance,
    _tolerance_defined: Boolean2,
    _tolerance: f64,
    start: f64,
    _stop_defined: Boolean2,
    _stop: f64,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi2SetupExperiment", &[Phase::Instantiated], |own| own.unit.begin(start))
    }
}

/// `fmi2EnterInitializationMode`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(instance: *mut Instance) -> Status {
    unsafe {
        Instance::call(instance, "fmi2EnterInitializationMode", &[Phase::Instantiated], |own| {
            own.phase = Phase::Initialization;
            Ok(())
        })
    }
}

/// `fmi2DoStep`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    instance: *mut Instance,
    time: f64,
    step: f64,
    _no_state_before: Boolean2,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi2DoStep", &[Phase::Step], |own| {
            let reached = own.unit.step(time, step, false)?;
            own.log.remark(&reached.remarks);
            Ok(())
        })
    }
}

values! {
    []
    Real: f64, fmi2GetReal, fmi2SetReal, |value| value, |value| value;
    Integer: c_int, fmi2GetInteger, fmi2SetInteger, |value| value as c_int, f64::from;
    Boolean: Boolean2, fmi2GetBoolean, fmi2SetBoolean, |value| Boolean2::from(value != 0.0), |value| f64::from(u8::from(value != 0));
}

/// `fmi2GetRealStatus`: the time that the unit is at.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(instance: *mut Instance, what: c_int, value: *mut f64) -> Status {
    unsafe {
        Instance::call(instance, "fmi2GetRealStatus", &Phase::ANY, |own| match what {
            LAST_SUCCESSFUL_TIME => {
                *given(value.as_mut())? = own.unit.get(0, Type::Real)?;
                Ok(())
            }
            _ => Err(Refusal::Error("steps end at once: there is no such status".into())),
        })
    }
}

refused! {
    fmi2GetString,
    fmi2SetString,
    fmi2GetDirectionalDerivative,
    fmi2SetRealInputDerivatives,
    fmi2GetRealOutputDerivatives,
    fmi2CancelStep,
    fmi2GetStatus,
    fmi2GetIntegerStatus,
    fmi2GetBooleanStatus,
    fmi2GetStringStatus,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resources_are_found_by_their_uri() {
        for (uri, path) in [
            ("file:///units/my%20unit/resources", "/units/my unit/resources"),
            ("file://localhost/units/r", "/units/r"),
            ("file:/units/r", "/units/r"),
            ("FILE:///units/r", "/units/r"),
            ("/units/100%", "/units/100%"),
            ("file:///C:/unit/resources", "C:/unit/resources"),
        ] {
            assert_eq!(path_of(uri), PathBuf::from(path), "{uri}");
        }
    }
}
