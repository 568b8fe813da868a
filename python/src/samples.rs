//! A curve's samples, which NumPy takes over without a copy.

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Values that `numpy.asarray` makes an array of; it keeps them alive, and nobody else writes to them.
#[pyclass(module = "impactcheck._core")]
pub struct Samples(pub Vec<f64>);

#[pymethods]
impl Samples {
    /// NumPy's array interface, version 3.
    #[getter]
    fn __array_interface__<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("shape", (self.0.len(),))?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f8" } else { ">f8" })?;
        // may be written to
        interface.set_item("data", (self.0.as_mut_ptr() as usize, false))?;
        Ok(interface)
    }
}
