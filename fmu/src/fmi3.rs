//! The C interface of FMI 3.0, co-simulation (`fmi3Functions.h`).
//!
//! # Safety
//! All functions are called as the standard states: instances and states come from this library, arrays have the stated lengths, texts end
//! with 0.
#![expect(clippy::missing_safety_doc, reason = "the standard states how these functions are called")]

use crate::instance::{Instance, InstanceLog, LogMessage3, Logger, Phase, Saved, Status, given, text};
use crate::shared::{life, refused, values};
use crate::unit::Refusal;
use crate::variables::Type;
use std::ffi::{c_char, c_void};
use std::path::Path;
use std::ptr;
use std::slice;

/// `fmi3GetVersion`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// `fmi3InstantiateCoSimulation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging_on: bool,
    event_mode_used: bool,
    early_return_allowed: bool,
    _intermediate: *const u32,
    intermediate_count: usize,
    environment: *mut c_void,
    log_message: Option<LogMessage3>,
    _intermediate_update: *const c_void,
) -> *mut Instance {
    let logger = log_message.map_or(Logger::Silent, Logger::Three);
    let log = InstanceLog { name: unsafe { text(name) }.to_owned(), logger, environment, is_on: logging_on };
    if event_mode_used || intermediate_count > 0 {
        log.write(Status::Error, "the unit has neither an event mode nor intermediate variables");
        return ptr::null_mut();
    }
    let (token, resources) = unsafe { (text(token), text(resources)) };
    Instance::create(log, token, Path::new(&*resources.to_string_lossy()), early_return_allowed)
}

life! {
    free: fmi3FreeInstance,
    exit_initialization: fmi3ExitInitializationMode,
    terminate: fmi3Terminate,
    reset: fmi3Reset,
    get_state: fmi3GetFMUState,
    set_state: fmi3SetFMUState,
    free_state: fmi3FreeFMUState,
    size_of_state: fmi3SerializedFMUStateSize,
    serialize: fmi3SerializeFMUState,
    deserialize: fmi3DeserializeFMUState,
}

/// `fmi3SetDebugLogging`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut Instance,
    on: bool,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi3SetDebugLogging", &Phase::ANY, |own| own.set_log(on, categories, count))
    }
}

/// `fmi3EnterInitializationMode`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut Instance,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi3EnterInitializationMode", &[Phase::Instantiated], |own| {
            own.unit.begin(start)?;
            own.phase = Phase::Initialization;
            Ok(())
        })
    }
}

/// `fmi3EnterStepMode`: without an event mode the unit is in it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterStepMode(instance: *mut Instance) -> Status {
    unsafe { Instance::call(instance, "fmi3EnterStepMode", &[Phase::Step], |_| Ok(())) }
}

/// `fmi3DoStep`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut Instance,
    time: f64,
    step: f64,
    _no_state_before: bool,
    event_needed: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last_time: *mut f64,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi3DoStep", &[Phase::Step], |own| {
            let reached = own.unit.step(time, step, own.may_stop)?;
            own.log.remark(&reached.remarks);
            let write = |place: *mut bool, value| {
                if let Some(place) = place.as_mut() {
                    *place = value;
                }
            };
            write(event_needed, false);
            write(terminate, false);
            write(early, reached.early);
            if let Some(place) = last_time.as_mut() {
                *place = reached.time;
            }
            Ok(())
        })
    }
}

fn of_same_length(references: usize, values: usize) -> Result<(), Refusal> {
    match references == values {
        true => Ok(()),
        false => Err(Refusal::Error(format!("{references} variables, but {values} values"))),
    }
}

values! {
    [value_count]
    Real: f64, fmi3GetFloat64, fmi3SetFloat64, |value| value, |value| value;
    Integer: i32, fmi3GetInt32, fmi3SetInt32, |value| value as i32, f64::from;
    Boolean: bool, fmi3GetBoolean, fmi3SetBoolean, |value| value != 0.0, |value| f64::from(u8::from(value));
}

/// `fmi3GetNumberOfVariableDependencies`: outputs depend on nothing at a communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(
    instance: *mut Instance,
    _reference: u32,
    count: *mut usize,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi3GetNumberOfVariableDependencies", &Phase::ANY, |_| {
            *given(count.as_mut())? = 0;
            Ok(())
        })
    }
}

/// `fmi3GetVariableDependencies`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetVariableDependencies(
    instance: *mut Instance,
    _dependent: u32,
    _elements: *const c_void,
    _independents: *const c_void,
    _others: *const c_void,
    _kinds: *const c_void,
    count: usize,
) -> Status {
    unsafe {
        Instance::call(instance, "fmi3GetVariableDependencies", &Phase::ANY, |_| of_same_length(0, count))
    }
}

/// `fmi3InstantiateModelExchange`: there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log_message: Option<LogMessage3>,
) -> *mut Instance {
    only_co_simulation(environment, log_message)
}

/// `fmi3InstantiateScheduledExecution`: there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    log_message: Option<LogMessage3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut Instance {
    only_co_simulation(environment, log_message)
}

fn only_co_simulation(environment: *mut c_void, log_message: Option<LogMessage3>) -> *mut Instance {
    let logger = log_message.map_or(Logger::Silent, Logger::Three);
    let log = InstanceLog { name: c"".to_owned(), logger, environment, is_on: true };
    log.write(Status::Error, "the unit is for co-simulation only");
    ptr::null_mut()
}

refused! {
    fmi3EnterEventMode,
    fmi3EnterConfigurationMode,
    fmi3ExitConfigurationMode,
    fmi3GetFloat32,
    fmi3GetInt8,
    fmi3GetUInt8,
    fmi3GetInt16,
    fmi3GetUInt16,
    fmi3GetUInt32,
    fmi3GetInt64,
    fmi3GetUInt64,
    fmi3GetString,
    fmi3GetBinary,
    fmi3GetClock,
    fmi3SetFloat32,
    fmi3SetInt8,
    fmi3SetUInt8,
    fmi3SetInt16,
    fmi3SetUInt16,
    fmi3SetUInt32,
    fmi3SetInt64,
    fmi3SetUInt64,
    fmi3SetString,
    fmi3SetBinary,
    fmi3SetClock,
    fmi3GetDirectionalDerivative,
    fmi3GetAdjointDerivative,
    fmi3GetIntervalDecimal,
    fmi3GetIntervalFraction,
    fmi3GetShiftDecimal,
    fmi3GetShiftFraction,
    fmi3SetIntervalDecimal,
    fmi3SetIntervalFraction,
    fmi3SetShiftDecimal,
    fmi3SetShiftFraction,
    fmi3EvaluateDiscreteStates,
    fmi3UpdateDiscreteStates,
    fmi3EnterContinuousTimeMode,
    fmi3CompletedIntegratorStep,
    fmi3SetTime,
    fmi3SetContinuousStates,
    fmi3GetContinuousStateDerivatives,
    fmi3GetEventIndicators,
    fmi3GetContinuousStates,
    fmi3GetNominalsOfContinuousStates,
    fmi3GetNumberOfEventIndicators,
    fmi3GetNumberOfContinuousStates,
    fmi3GetOutputDerivatives,
    fmi3ActivateModelPartition,
}
