//! The networks and the engine that runs them. `models/README.md` describes their inputs and outputs.

use super::SeeError;
use crate::elementary::Elementary as _;
use crate::raster::Raster;
use rten::{Model, ModelOptions, RunOptions, ThreadPool, Value, op_registry};
use std::sync::Arc;

/// Detects faces.
pub(super) const DETECTOR: Weights = Weights {
    name: "face_detection_short_range",
    bytes: include_bytes!("../../models/face_detection_short_range.onnx"),
    side: 128,
};
/// Finds a face's 468 landmarks.
pub(super) const MESH: Weights =
    Weights { name: "face_landmark", bytes: include_bytes!("../../models/face_landmark.onnx"), side: 192 };
/// Finds an eye's lids and iris.
pub(super) const IRIS: Weights =
    Weights { name: "iris_landmark", bytes: include_bytes!("../../models/iris_landmark.onnx"), side: 64 };
/// Separates people from the background.
pub(super) const PERSON: Weights =
    Weights { name: "selfie_segmentation", bytes: include_bytes!("../../models/selfie_segmentation.onnx"), side: 256 };

/// A network's weights and metadata.
pub(super) struct Weights {
    name: &'static str,
    bytes: &'static [u8],
    /// Columns and rows of its input picture.
    pub side: usize,
}

/// The threads that networks run on.
pub(super) struct Engine {
    threads: Arc<ThreadPool>,
}

impl Engine {
    /// An engine with as many threads as rayon.
    pub(super) fn new() -> Self {
        Self { threads: Arc::new(ThreadPool::with_num_threads(rayon::current_num_threads())) }
    }

    pub(super) fn load(&self, weights: &Weights) -> Result<Network, SeeError> {
        // Only the operators of these four networks, to keep the binary small.
        let operators = op_registry!(
            Add,
            AveragePool,
            Cast,
            Clip,
            Concat,
            Conv,
            ConvTranspose,
            DepthToSpace,
            GlobalAveragePool,
            HardSigmoid,
            HardSwish,
            Identity,
            MaxPool,
            Mul,
            PRelu,
            Pad,
            Relu,
            Reshape,
            Resize,
            Sigmoid,
            Transpose
        );
        let name = weights.name;
        let model = ModelOptions::with_ops(operators).load_static_slice(weights.bytes);
        let model = model.map_err(|error| SeeError::Network { network: name, reason: error.to_string() })?;
        Ok(Network { name, model, side: weights.side, threads: Arc::clone(&self.threads) })
    }
}

/// A network ready to run.
pub(super) struct Network {
    name: &'static str,
    model: Model,
    /// Columns and rows of its input picture.
    pub side: usize,
    threads: Arc<ThreadPool>,
}

impl Network {
    /// The network's outputs for a picture of its side, in byte values as floats; the network's input is `scale * byte + offset`.
    pub(super) fn run<const N: usize>(
        &self,
        picture: &Raster<[f32; 3]>,
        scale: f32,
        offset: f32,
    ) -> Result<[Vec<f32>; N], SeeError> {
        let failed = |reason: String| SeeError::Network { network: self.name, reason };
        let planes = (0..3).flat_map(|k| picture.pixels().iter().map(move |colour| scale * colour[k] + offset)).collect();
        let input = Value::from_shape([1, 3, self.side, self.side], planes).map_err(|error| failed(error.to_string()))?;
        let id = *self.model.input_ids().first().ok_or_else(|| failed("it has no input".to_owned()))?;
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(&self.threads)));
        let outputs = self.model.run(vec![(id, input.into())], self.model.output_ids(), Some(options));
        let outputs: Vec<Vec<f32>> = outputs
            .map_err(|error| failed(error.to_string()))?
            .into_iter()
            .filter_map(|value| if let Value::FloatTensor(tensor) = value { Some(tensor.into_data()) } else { None })
            .collect();
        let count = outputs.len();
        outputs.try_into().map_err(|_| failed(format!("it returned {count} outputs instead of {N}")))
    }
}

/// The logistic function, which turns a network's output into a probability.
pub(super) fn sigmoid(v: f32) -> f64 {
    1.0 / (1.0 + f64::from(-v).exponential())
}

/// Rounds a length in pixels to 1/16.
pub(super) fn sixteenths(v: f64) -> f64 {
    (16.0 * v).round() / 16.0
}

/// Rounds a probability to 1/1000.
pub(super) fn thousandths(v: f64) -> f64 {
    (1000.0 * v).round() / 1000.0
}
