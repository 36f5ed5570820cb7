//! Arrays between numpy and the library.

use crate::errors::setting;
use bytemuck::{Pod, cast_slice};
use numpy::{
    Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods,
    ndarray::{ArrayView1, ArrayView2},
};
use pyo3::prelude::*;

/// An argument that numpy converts to an array of `f32`: an array of any number type, or nested lists.
pub struct Floats<'py>(PyReadonlyArrayDyn<'py, f32>);

impl<'a, 'py> FromPyObject<'a, 'py> for Floats<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let numpy = object.py().import("numpy")?;
        let array = numpy.call_method1("ascontiguousarray", (object, "float32"))?;
        Ok(Self(array.cast_into::<PyArrayDyn<f32>>()?.readonly()))
    }
}

impl Floats<'_> {
    /// The numbers, of an array of any shape.
    pub fn numbers(&self) -> PyResult<&[f32]> {
        Ok(self.0.as_slice()?)
    }

    /// The rows of an array of shape `[rows, N]`, or of one row of shape `[N]`. `name` is the argument's.
    pub fn rows<T: Pod, const N: usize>(&self, name: &str) -> PyResult<&[T]> {
        const { assert!(size_of::<T>() == N * size_of::<f32>()) };
        match self.0.shape() {
            [_, n] | [n] if *n == N => Ok(cast_slice(self.numbers()?)),
            other => Err(setting(format!("`{name}` must have the shape [n, {N}], but has {other:?}"))),
        }
    }

    /// A vector of `N` finite numbers.
    pub fn vector<T: Pod, const N: usize>(&self, name: &str) -> PyResult<T> {
        match self.rows::<T, N>(name)? {
            [one] if self.numbers()?.iter().all(|x| x.is_finite()) => Ok(*one),
            _ => Err(setting(format!("`{name}` must be {N} finite numbers"))),
        }
    }

    /// The shape of the array.
    pub fn shape(&self) -> &[usize] {
        self.0.shape()
    }
}

/// An argument that numpy converts to an array of `u32`.
pub struct Indices<'py>(PyReadonlyArrayDyn<'py, u32>);

impl<'a, 'py> FromPyObject<'a, 'py> for Indices<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let numpy = object.py().import("numpy")?;
        let given = numpy.call_method1("asarray", (object,))?;
        let array = numpy.call_method1("ascontiguousarray", (&given, "uint32"))?;
        // Numbers that are negative, too large or fractional do not survive the conversion.
        let same: bool = numpy.call_method1("array_equal", (&array, &given))?.extract()?;
        if !same {
            return Err(setting("indices must be whole numbers from 0 to 4294967295"));
        }
        Ok(Self(array.cast_into::<PyArrayDyn<u32>>()?.readonly()))
    }
}

impl Indices<'_> {
    /// The indices, of an array of any shape.
    pub fn numbers(&self) -> PyResult<&[u32]> {
        Ok(self.0.as_slice()?)
    }

    /// The rows of an array of shape `[n, 3]`.
    pub fn triples(&self, name: &str) -> PyResult<&[[u32; 3]]> {
        match self.0.shape() {
            [_, 3] => Ok(cast_slice(self.numbers()?)),
            other => Err(setting(format!("`{name}` must have the shape [n, 3], but has {other:?}"))),
        }
    }
}

/// Returns a read-only array of shape `[rows, N]` over memory that `owner` keeps.
///
/// # Safety
/// `rows` must belong to `owner`, which must not change or move it while it lives.
pub unsafe fn shared_rows<'py, T: Pod, const N: usize>(
    rows: &[T],
    owner: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let numbers: &[f32] = cast_slice(rows);
    let view = ArrayView2::from_shape((rows.len(), N), numbers).map_err(setting)?;
    // SAFETY: by the contract of this function, the memory outlives the array, which keeps `owner` alive.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner) };
    read_only(array)
}

/// Returns a read-only array of shape `[n]` over memory that `owner` keeps.
///
/// # Safety
/// As for [`shared_rows`].
pub unsafe fn shared<'py, T: Element>(
    numbers: &[T],
    owner: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray1<T>>> {
    // SAFETY: by the contract of this function, the memory outlives the array, which keeps `owner` alive.
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(numbers), owner) };
    read_only(array)
}

fn read_only<'py, T, D>(
    array: Bound<'py, numpy::PyArray<T, D>>,
) -> PyResult<Bound<'py, numpy::PyArray<T, D>>> {
    let flags = pyo3::types::PyDict::new(array.py());
    flags.set_item("write", false)?;
    array.as_any().call_method("setflags", (), Some(&flags))?;
    Ok(array)
}

/// Copies rows to a new array of shape `[rows, N]`.
pub fn copied_rows<'py, T: Pod, const N: usize>(
    py: Python<'py>,
    rows: &[T],
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let flat = PyArray1::from_slice(py, cast_slice::<T, f32>(rows));
    flat.reshape([rows.len(), N])
}

/// An array of `f32` of shape `[rows, 3]` that Python allocated and that a function fills.
pub fn fill_rows<'py, const N: usize>(
    array: &Bound<'py, PyAny>,
    rows: usize,
    name: &str,
    fill: impl FnOnce(&mut [f32]),
) -> PyResult<()> {
    let shape = || setting(format!("`{name}` must be a contiguous float32 array of shape [{rows}, {N}]"));
    let array = array.cast::<PyArray2<f32>>().map_err(|_| shape())?;
    if array.shape() != [rows, N] || !array.is_c_contiguous() {
        return Err(shape());
    }
    let mut guard = array.try_readwrite().map_err(|_| setting(format!("`{name}` cannot be written to")))?;
    fill(guard.as_slice_mut().map_err(|_| shape())?);
    Ok(())
}
