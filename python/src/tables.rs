//! Tables of results: to pandas, polars, pyarrow and DuckDB by the Arrow PyCapsule interface, column by column as arrays.
//!
//! Must not know: which study they are of.

use std::sync::{Arc, OnceLock};

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{RecordBatch, RecordBatchIterator};
use numpy::IntoPyArray;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyIterator, PyList};

use declare::error::suggest;
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table as Inner};

use crate::errors::run_failed;

/// A table of a stage; :attr:`gearstudy.Study.tables` has them by name.
///
/// pandas, polars, pyarrow and DuckDB read it by the Arrow PyCapsule interface (``polars.DataFrame(table)``,
/// ``pyarrow.table(table)``, ``pandas.DataFrame.from_arrow(table)``), with units in the metadata of its fields; pandas by itself
/// knows no metadata of fields, which :meth:`to_pandas` gives it.
///
/// >>> table = study.tables["ste.summary"]
/// >>> table["peak_to_peak"].shape == (len(table),)
/// True
/// >>> table.units["peak_to_peak"]
/// 'um'
#[pyclass(frozen, module = "gearstudy._gearstudy")]
pub struct Table {
    name: String,
    held: Arc<Inner>,
    /// The same for whoever reads Arrow, made when the first asks; all have the same memory.
    arrow: OnceLock<RecordBatch>,
}

impl Table {
    pub fn new(name: &str, table: Inner) -> Self {
        Self { name: name.to_owned(), held: Arc::new(table), arrow: OnceLock::new() }
    }
}

#[pymethods]
impl Table {
    /// The names of its stage and its own, ``stage.table``.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// What it has, in a sentence.
    #[getter]
    fn description(&self) -> &str {
        &self.held.schema().description
    }

    /// The names of its columns, in order.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        self.held.schema().columns.iter().map(|column| column.name.as_str()).collect()
    }

    /// The columns that tell its rows apart.
    #[getter]
    fn key_columns(&self) -> Vec<&str> {
        self.held.schema().columns.iter().filter(|column| column.key).map(|column| column.name.as_str()).collect()
    }

    /// Unit by column, of those that have one: that in which its values are.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.told(py, |column| &column.unit)
    }

    /// Description by column.
    #[getter]
    fn descriptions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.told(py, |column| &column.description)
    }

    fn __len__(&self) -> usize {
        self.held.rows()
    }

    fn __contains__(&self, column: &Bound<'_, PyAny>) -> bool {
        column.extract::<&str>().is_ok_and(|column| self.held.column(column).is_some())
    }

    /// The names of its columns; with them ``dict(table)`` has all of it.
    fn keys(&self) -> Vec<&str> {
        self.columns()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.columns())?.try_iter()
    }

    fn __repr__(&self) -> String {
        format!("Table({:?}, rows={}, columns={:?})", self.name, self.held.rows(), self.columns())
    }

    /// A column as an array of shape (rows,) of its own, texts as a list.
    fn __getitem__<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(data) = self.held.column(column) else {
            let help = suggest(column, self.columns());
            return Err(PyKeyError::new_err(format!("`{}` has no column `{column}`; {help}", self.name)));
        };
        Ok(match data {
            Data::Float(values) => values.clone().into_pyarray(py).into_any(),
            Data::Integer(values) => values.clone().into_pyarray(py).into_any(),
            Data::Flag(values) => values.clone().into_pyarray(py).into_any(),
            Data::Text(values) => PyList::new(py, values)?.into_any(),
        })
    }

    /// A DataFrame of pandas, whose ``attrs`` have the table's ``name`` and ``description``, and ``units`` and ``descriptions`` by column.
    ///
    /// >>> frame = study.tables["ste.summary"].to_pandas()
    /// >>> frame.attrs["units"]["torque"]
    /// 'N m'
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        for column in self.columns() {
            columns.set_item(column, self.__getitem__(py, column)?)?;
        }
        let frame = py.import("pandas")?.call_method1("DataFrame", (columns,))?;
        let attributes = frame.getattr("attrs")?;
        attributes.set_item("name", self.name())?;
        attributes.set_item("description", self.description())?;
        attributes.set_item("units", self.units(py)?)?;
        attributes.set_item("descriptions", self.descriptions(py)?)?;
        Ok(frame)
    }

    /// The stream of the Arrow PyCapsule interface.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A reader that wants other types converts: the interface lets a producer do so.
        let _ = requested_schema;
        let batch = match self.arrow.get() {
            Some(batch) => batch.clone(),
            None => {
                let made = parquet::in_memory(&self.held).map_err(|error| run_failed(py, &error))?;
                self.arrow.get_or_init(|| made).clone()
            }
        };
        let schema = batch.schema();
        let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }
}

impl Table {
    fn told<'py>(
        &self,
        py: Python<'py>,
        what: impl Fn(&studygraph::table::schema::Column) -> &String,
    ) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for column in self.held.schema().columns.iter().filter(|column| !what(column).is_empty()) {
            all.set_item(&column.name, what(column))?;
        }
        Ok(all)
    }
}
