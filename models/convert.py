"""Makes the networks of this folder from the TensorFlow Lite files inside the wheel of mediapipe 0.10.14.

    python models/convert.py mediapipe-0.10.14-*.whl models/

Needs numpy, onnx and tflite. TensorFlow Lite keeps channels last, ONNX keeps them first: four-dimensional tensors are transposed
once, here, and only a reshape needs the old order in the graph. Tensors of more than 64 numbers are stored in 16 bits, which is how
most of them are stored in the wheel.
"""

import hashlib
import sys
import zipfile
from pathlib import Path

import numpy as np
import onnx
import tflite
from onnx import TensorProto, helper, numpy_helper

WHEEL = "a807328339e7356fda0bb14df12fedbf1d33bdf81649c5f8666b0026b1cc30b4"
NETWORKS = [
    "face_detection/face_detection_short_range",
    "face_landmark/face_landmark",
    "iris_landmark/iris_landmark",
    "selfie_segmentation/selfie_segmentation",
]
LARGE = 64  # numbers in a tensor beyond which 16 bits are used
NUMPY = {0: np.float32, 1: np.float16, 2: np.int32, 4: np.int64}
OPERATORS = {code: name for name, code in vars(tflite.BuiltinOperator).items() if isinstance(code, int)}


def options(operator, kind):
    table = operator.BuiltinOptions()
    read = kind()
    read.Init(table.Bytes, table.Pos)
    return read


def same_padding(size, kernel, stride, dilation):
    """Rows before and after, as TensorFlow's SAME means it: the odd one after."""
    wanted = (-(-size // stride) - 1) * stride + (kernel - 1) * dilation + 1 - size
    wanted = max(wanted, 0)
    return wanted // 2, wanted - wanted // 2


class Graph:
    """One network on its way from one format to the other."""

    def __init__(self, data):
        self.model = tflite.Model.GetRootAsModel(data, 0)
        self.graph = self.model.Subgraphs(0)
        self.nodes, self.weights, self.constants = [], {}, {}
        for index in range(self.graph.TensorsLength()):
            self.read_constant(index)

    def shape(self, index):
        tensor = self.graph.Tensors(index)
        return [int(n) for n in tensor.ShapeAsNumpy()] if tensor.ShapeLength() else []

    def read_constant(self, index):
        tensor = self.graph.Tensors(index)
        buffer = self.model.Buffers(tensor.Buffer())
        if buffer.DataLength() == 0:
            return
        if tensor.Sparsity() is not None and tensor.Sparsity().DimMetadataLength() > 0:
            raise ValueError("sparse tensors do not occur in these four networks")
        values = np.frombuffer(buffer.DataAsNumpy().tobytes(), NUMPY[tensor.Type()]).reshape(self.shape(index))
        self.constants[index] = values.astype(np.float32) if values.dtype == np.float16 else values

    def weight(self, values):
        name = f"w{len(self.weights)}"
        self.weights[name] = np.ascontiguousarray(values)
        return name

    def add(self, operator, inputs, output=None, **attributes):
        output = output or f"x{len(self.nodes)}"
        self.nodes.append(helper.make_node(operator, inputs, [output], **attributes))
        return output

    def value(self, index):
        """A tensor's name; a constant is put in with its channels first."""
        if index not in self.constants:
            return f"t{index}"
        values = self.constants[index]
        if values.ndim == 4:
            values = values.transpose(0, 3, 1, 2)
        elif values.ndim == 3:
            values = values.transpose(2, 0, 1)
        elif values.ndim == 1:
            values = values.reshape(-1, 1, 1)
        return self.weight(values)

    def activated(self, name, kind, output):
        """What follows an operator that has its activation built in: none, ReLU or ReLU up to 6."""
        if kind == 0:
            self.add("Identity", [name], output)
        elif kind == 1:
            self.add("Relu", [name], output)
        elif kind == 3:
            self.add("Clip", [name, self.weight(np.float32(0)), self.weight(np.float32(6))], output)
        else:
            raise ValueError(f"activation {kind}")

    def padding(self, index, kernel, strides, dilations, kind):
        if kind == 1:  # VALID
            return [0, 0, 0, 0]
        sizes = self.shape(index)[1:3]
        ends = [same_padding(*numbers) for numbers in zip(sizes, kernel, strides, dilations)]
        return [ends[0][0], ends[1][0], ends[0][1], ends[1][1]]

    def convolution(self, inputs, output, read, is_depthwise):
        weights = self.constants[inputs[1]]
        kernel = list(weights.shape[1:3])
        strides = [read.StrideH(), read.StrideW()]
        dilations = [read.DilationHFactor(), read.DilationWFactor()]
        order = (3, 0, 1, 2) if is_depthwise else (0, 3, 1, 2)
        names = [self.value(inputs[0]), self.weight(weights.transpose(order))]
        if len(inputs) > 2 and inputs[2] >= 0:
            names.append(self.weight(self.constants[inputs[2]]))
        result = self.add(
            "Conv",
            names,
            kernel_shape=kernel,
            strides=strides,
            dilations=dilations,
            group=self.shape(inputs[0])[3] if is_depthwise else 1,
            pads=self.padding(inputs[0], kernel, strides, dilations, read.Padding()),
        )
        self.activated(result, read.FusedActivationFunction(), output)

    def transposed_convolution(self, inputs, output, custom):
        """MediaPipe's own operator: padding, stride across, stride down."""
        weights = self.constants[inputs[1]]
        _, across, down = np.frombuffer(custom[:12], np.int32)
        names = [self.value(inputs[0]), self.weight(weights.transpose(3, 0, 1, 2)), self.weight(self.constants[inputs[2]])]
        self.add("ConvTranspose", names, output, kernel_shape=list(weights.shape[1:3]), strides=[int(down), int(across)])

    def pool(self, operator, inputs, output, read):
        kernel, strides = [read.FilterHeight(), read.FilterWidth()], [read.StrideH(), read.StrideW()]
        if operator == "AveragePool" and kernel == self.shape(inputs[0])[1:3]:
            self.add("GlobalAveragePool", [self.value(inputs[0])], output)
            return
        pads = self.padding(inputs[0], kernel, strides, [1, 1], read.Padding())
        self.add(operator, [self.value(inputs[0])], output, kernel_shape=kernel, strides=strides, pads=pads)

    def resize(self, inputs, output_index, output, read):
        before, after = self.shape(inputs[0]), self.shape(output_index)
        mode = "align_corners" if read.AlignCorners() else "half_pixel" if read.HalfPixelCenters() else "asymmetric"
        scales = np.array([1, 1, after[1] / before[1], after[2] / before[2]], np.float32)
        names = [self.value(inputs[0]), "", self.weight(scales)]
        self.add("Resize", names, output, mode="linear", coordinate_transformation_mode=mode)

    def reshape(self, inputs, output_index, output):
        name, shape = self.value(inputs[0]), self.shape(output_index)
        if len(self.shape(inputs[0])) == 4:
            name = self.add("Transpose", [name], perm=[0, 2, 3, 1])
        target = self.weight(np.array(shape, np.int64))
        if len(shape) == 4:
            self.add("Transpose", [self.add("Reshape", [name, target])], output, perm=[0, 3, 1, 2])
        else:
            self.add("Reshape", [name, target], output)

    def operator(self, operator):
        code = self.model.OperatorCodes(operator.OpcodeIndex())
        number = max(code.BuiltinCode(), code.DeprecatedBuiltinCode())
        name = OPERATORS[number] if number != tflite.BuiltinOperator.CUSTOM else code.CustomCode().decode()
        inputs = [operator.Inputs(i) for i in range(operator.InputsLength())]
        index = operator.Outputs(0)
        output = f"t{index}"
        if name in ("DEQUANTIZE", "DENSIFY"):
            self.constants[index] = self.constants[inputs[0]]
        elif name == "CONV_2D":
            self.convolution(inputs, output, options(operator, tflite.Conv2DOptions), False)
        elif name == "DEPTHWISE_CONV_2D":
            self.convolution(inputs, output, options(operator, tflite.DepthwiseConv2DOptions), True)
        elif name == "Convolution2DTransposeBias":
            self.transposed_convolution(inputs, output, operator.CustomOptionsAsNumpy().tobytes())
        elif name == "HARD_SWISH":
            gate = self.add("HardSigmoid", [self.value(inputs[0])], alpha=1 / 6, beta=0.5)
            self.add("Mul", [self.value(inputs[0]), gate], output)
        elif name in ("RELU", "LOGISTIC"):
            self.add("Relu" if name == "RELU" else "Sigmoid", [self.value(inputs[0])], output)
        elif name in ("ADD", "MUL"):
            read = options(operator, tflite.AddOptions if name == "ADD" else tflite.MulOptions)
            result = self.add("Add" if name == "ADD" else "Mul", [self.value(i) for i in inputs])
            self.activated(result, read.FusedActivationFunction(), output)
        elif name == "PRELU":
            self.add("PRelu", [self.value(i) for i in inputs], output)
        elif name in ("AVERAGE_POOL_2D", "MAX_POOL_2D"):
            kind = "AveragePool" if name.startswith("A") else "MaxPool"
            self.pool(kind, inputs, output, options(operator, tflite.Pool2DOptions))
        elif name == "PAD":
            ends = self.constants[inputs[1]]
            ends = ends[[0, 3, 1, 2]] if ends.shape[0] == 4 else ends
            pads = np.concatenate([ends[:, 0], ends[:, 1]]).astype(np.int64)
            self.add("Pad", [self.value(inputs[0]), self.weight(pads)], output)
        elif name == "RESIZE_BILINEAR":
            self.resize(inputs, index, output, options(operator, tflite.ResizeBilinearOptions))
        elif name == "DEPTH_TO_SPACE":
            size = options(operator, tflite.DepthToSpaceOptions).BlockSize()
            self.add("DepthToSpace", [self.value(inputs[0])], output, blocksize=size, mode="DCR")
        elif name == "RESHAPE":
            self.reshape(inputs, index, output)
        elif name == "CONCATENATION":
            dimensions = len(self.shape(index))
            axis = options(operator, tflite.ConcatenationOptions).Axis() % dimensions
            axis = [0, 2, 3, 1][axis] if dimensions == 4 else axis
            self.add("Concat", [self.value(i) for i in inputs], output, axis=axis)
        else:
            raise ValueError(f"operator {name}")

    def ends(self, indices):
        def info(index):
            shape = self.shape(index)
            shape = [shape[0], shape[3], shape[1], shape[2]] if len(shape) == 4 else shape
            return helper.make_tensor_value_info(f"t{index}", TensorProto.FLOAT, shape)

        return [info(index) for index in indices]

    def converted(self):
        graph = self.graph
        for index in range(graph.OperatorsLength()):
            self.operator(graph.Operators(index))
        stored, casts = [], []
        for name, values in self.weights.items():
            if values.dtype == np.float32 and values.size > LARGE:
                stored.append(numpy_helper.from_array(values.astype(np.float16), name + "h"))
                casts.append(helper.make_node("Cast", [name + "h"], [name], to=TensorProto.FLOAT))
            else:
                stored.append(numpy_helper.from_array(values, name))
        inputs = self.ends(graph.Inputs(i) for i in range(graph.InputsLength()))
        outputs = self.ends(graph.Outputs(i) for i in range(graph.OutputsLength()))
        whole = helper.make_graph(casts + self.nodes, "g", inputs, outputs, stored)
        model = helper.make_model(whole, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
        onnx.checker.check_model(model)
        return model


def main(wheel, folder):
    found = hashlib.sha256(Path(wheel).read_bytes()).hexdigest()
    if found != WHEEL:
        sys.exit(f"{wheel} has the sha256 {found}, not {WHEEL}")
    with zipfile.ZipFile(wheel) as archive:
        for network in NETWORKS:
            model = Graph(archive.read(f"mediapipe/modules/{network}.tflite")).converted()
            path = Path(folder) / (Path(network).name + ".onnx")
            onnx.save(model, str(path))
            print(path, hashlib.sha256(path.read_bytes()).hexdigest())


if __name__ == "__main__":
    main(*sys.argv[1:])
