// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

using cv::stereo::RigDrift;
using cv::stereo::StereoCalibration;
using cv::stereo::StereoRig;

namespace {

typedef std::pair<int, int> Pair;

cv::Size toSize(const Pair& size) { return cv::Size(size.first, size.second); }

//! A copy: the object outlives the array. given: an array, or a list
cv::Mat toMatrix(const py::object& given, const char* name)
{
    const py::array array =
        py::isinstance<py::array>(given) ? py::reinterpret_borrow<py::array>(given) : py::array::ensure(given);
    if (!array)
        throw py::type_error(std::string(name) + " must be a numpy array, not " + typeOf(given));
    std::vector<py::array> kept;
    const bool isWhole = array.dtype().kind() == 'i' || array.dtype().kind() == 'u'; // as typed without points
    py::array matrix = isWhole ? py::array(array.attr("astype")("float64")) : array;
    if (matrix.ndim() == 1)
        matrix = py::array(matrix.attr("reshape")(1, -1));
    return toMat(matrix, name, kept).clone();
}

void addCalibration(py::module_& module)
{
    py::class_<StereoCalibration> calibration(module, "StereoCalibration", R"doc(
What a calibration says of two cameras side by side, as cv2.stereoCalibrate has it.

A point X of the left camera is R X + T in the right one: x to the right, y down, z forward. T is in metres. distCoeffs1
and distCoeffs2 have 4, 5, 8, 12 or 14 numbers; with isFisheye they are those of cv2.fisheye, 4 numbers. Matrices
are copies, and read-only: assign others.)doc");
    setPackage(calibration);
    calibration.def(py::init<>(), "A calibration without matrices");
    calibration.def_property(
        "imageSize", [](const StereoCalibration& self) { return Pair(self.imageSize.width, self.imageSize.height); },
        [](StereoCalibration& self, const py::object& size) {
        py::detail::make_caster<Pair> pair;
        if (!pair.load(size, false))
            throw py::type_error("imageSize must be a pair of ints");
        self.imageSize = toSize(py::detail::cast_op<Pair>(pair));
        },
        "Width and height of the raw images, in pixels");
    const auto matrix = [&](const char* name, cv::Mat StereoCalibration::*field, const char* documentation) {
        calibration.def_property(
            name, [field](const StereoCalibration& self) { return readOnly(toPython((self.*field).clone())); },
            [field, name](StereoCalibration& self, const py::object& value) { self.*field = toMatrix(value, name); },
            documentation);
    };
    matrix("cameraMatrix1", &StereoCalibration::cameraMatrix1, "Left camera: 3 x 3, in pixels");
    matrix("distCoeffs1", &StereoCalibration::distCoeffs1, "Distortion of the left camera");
    matrix("cameraMatrix2", &StereoCalibration::cameraMatrix2, "Right camera: 3 x 3, in pixels");
    matrix("distCoeffs2", &StereoCalibration::distCoeffs2, "Distortion of the right camera");
    matrix("R", &StereoCalibration::R, "Rotation from the left to the right camera: 3 x 3");
    matrix("T", &StereoCalibration::T, "Translation from the left to the right camera: 3 x 1, in metres");
    calibration.def_property(
        "isFisheye", [](const StereoCalibration& self) { return self.isFisheye; },
        setterOf(calibration, "isFisheye", &StereoCalibration::isFisheye), "Whether distortion is that of cv2.fisheye");

    module.def(
        "readStereoCalibration",
        [](const py::object& first, const py::object& second, const Pair& imageSize, double unit) {
        return cv::stereo::readStereoCalibration(
            nameOfFile(first), second.is_none() ? std::string() : nameOfFile(second), toSize(imageSize), unit);
        },
        py::arg("first"), py::arg("second") = py::none(), py::arg("imageSize") = Pair(0, 0), py::arg("unit") = 1.,
        R"doc(
Reads a calibration: OpenCV's intrinsics.yml and extrinsics.yml, ROS's left.yaml and right.yaml, EuRoC's two
sensor.yaml, Kalibr's camchain.yaml, or the ZED's SN12345.conf.

first: file of the left camera, or the only one.
second: file of the right camera, or with R and T.
imageSize: width and height of the raw images. The calibration is scaled if these have the same aspect. OpenCV's and the
ZED's files do not have it; with the others it is that of the calibration by default.
unit: metres in a unit of T, in OpenCV's files.

Raises OSError if a file cannot be opened, and ValueError with the file and the field if something is missing, not
finite or impossible.)doc");
}

void addRig(py::module_& module)
{
    py::class_<StereoRig, cv::Ptr<StereoRig>> rig(module, "StereoRig", R"doc(
A calibrated pair of cameras: from raw images to rectified ones, and from disparities to depth.

    rig = hdpstereo.StereoRig.create(hdpstereo.readStereoCalibration('left.yaml', 'right.yaml'))
    left, right = rig.rectify(raw_left, raw_right)
    depth = rig.computeDepth(matcher.compute(left, right))  # metres, NaN where there is none

An object is constant: threads may share it.)doc");
    setPackage(rig);
    const auto create = [](const StereoCalibration& calibration, double fieldOfView, const Pair& size) {
        return StereoRig::create(calibration, fieldOfView, toSize(size));
    };
    const char* const createHelp = R"doc(
Creates a rig.

calibration: see readStereoCalibration().
fieldOfView: horizontal field of view of the rectified images in degrees, 1 to 170. 0: without fisheye as much as has no
empty pixels, but for a column or row at a border; with fisheye what keeps the focal length.
size: width and height of the rectified images; by default those of the raw ones.)doc";
    rig.def(py::init(create), py::arg("calibration"), py::arg("fieldOfView") = 0., py::arg("size") = Pair(0, 0),
            createHelp);
    rig.def_static("create", create, py::arg("calibration"), py::arg("fieldOfView") = 0., py::arg("size") = Pair(0, 0),
                   createHelp);
    rig.def(
        "rectify",
        [](const StereoRig& self, const py::array& leftArray, const py::array& rightArray) {
        std::vector<py::array> kept;
        const cv::Mat left = toMat(leftArray, "left", kept), right = toMat(rightArray, "right", kept);
        cv::Mat rectified[2];
        {
            const py::gil_scoped_release release;
            self.rectify(left, right, rectified[0], rectified[1]);
        }
        return py::make_tuple(toPython(rectified[0]), toPython(rectified[1]));
        },
        py::arg("left"), py::arg("right"), R"doc(
Returns the rectified left and right image. What no raw pixel reaches is 0.

left, right: raw images of the calibration's size: uint8, uint16 or float32, 1, 3 or 4 channels.)doc");
    rig.def(
        "getMasks",
        [](const StereoRig& self) {
        cv::Mat masks[2];
        self.getMasks(masks[0], masks[1]);
        return py::make_tuple(toPython(masks[0]), toPython(masks[1]));
        },
        "Returns uint8 of the rectified left and right image: 255, or 0 for what no raw pixel reaches.");
    rig.def(
        "computeDepth",
        [](const StereoRig& self, const py::array& array, bool millimetres, int minDisparity) {
        std::vector<py::array> kept;
        cv::Mat depth;
        self.computeDepth(toMat(array, "disparity", kept), depth, millimetres ? CV_16U : CV_32F, minDisparity);
        return toPython(depth);
        },
        py::arg("disparity"), py::arg("millimetres").noconvert() = false, py::arg("minDisparity") = 0, R"doc(
Returns the depth of each pixel, its distance from the cameras' plane: float32 in metres, NaN where there is none.

disparity: int16, times 16, or float32 in pixels.
millimetres: True for uint16 in millimetres, 0 where there is none, or more than 65.535 m.
minDisparity: what is less, not above 0 or not finite is no disparity. In pixels.)doc");
    rig.def(
        "getRectification",
        [](const StereoRig& self) {
        cv::Mat m[5];
        self.getRectification(m[0], m[1], m[2], m[3], m[4]);
        return py::make_tuple(toPython(m[0]), toPython(m[1]), toPython(m[2]), toPython(m[3]), toPython(m[4]));
        },
        "Returns R1, R2, P1, P2 and Q, as cv2.stereoRectify does; Q leads to metres.");
    rig.def("getCalibration", &StereoRig::getCalibration, "Returns the calibration.");
    rig.def(
        "getSize", [](const StereoRig& self) { return Pair(self.getSize().width, self.getSize().height); },
        "Returns width and height of the rectified images.");
    rig.def("getBaseline", &StereoRig::getBaseline, "Returns the distance of the cameras in metres.");
    rig.def("getFocalLength", &StereoRig::getFocalLength,
            "Returns the focal length of the rectified images in pixels.");
}

void addDrift(py::module_& module)
{
    py::class_<RigDrift, cv::Ptr<RigDrift>> drift(module, "RigDrift", R"doc(
How the right camera of a rig has turned since its calibration, by what rows reveal.

    drift = hdpstereo.RigDrift.create(P2, rig.getSize())  # P2 of rig.getRectification()
    drift.add(matcher.getFindings().rows)                 # after each compute()
    rig = hdpstereo.StereoRig.create(drift.correct(rig.getCalibration(), R2))

Pitch and roll are found to a hundredth of a degree. Of yaw and the focal length rows tell little: how little, the
deviations say. They are corrected only if they exceed two of these.)doc");
    setPackage(drift);
    const auto create = [](const py::array& P2, const Pair& imageSize, int memory) {
        return RigDrift::create(toMatrix(P2, "P2"), toSize(imageSize), memory);
    };
    const char* const createHelp = R"doc(
Creates an estimate that knows nothing yet.

P2: projection of the rectified right camera, 3 x 3 or 3 x 4.
imageSize: width and height of the rectified images.
memory: after so many frames, the oldest begin to be forgotten.)doc";
    drift.def(py::init(create), py::arg("P2"), py::arg("imageSize"), py::arg("memory") = 100, createHelp);
    drift.def_static("create", create, py::arg("P2"), py::arg("imageSize"), py::arg("memory") = 100, createHelp);
    drift.def("add", &RigDrift::add, py::arg("rows"), R"doc(
Takes a frame into account; returns whether it was: False if all rows are 0, or contradict the frames before.

rows: HDPTreeMatcher.Findings.rows. After five contradictions in a row the frames before are forgotten.)doc");
    drift.def("getFrames", &RigDrift::getFrames, "Returns how many frames were taken into account.");
    drift.def(
        "getEstimate",
        [](const RigDrift& self) {
        std::vector<double> values, deviations;
        self.getEstimate(values, deviations);
        return py::make_tuple(toPython(values), toPython(deviations));
        },
        R"doc(
Returns how the right camera has turned, and standard deviations, which are infinite before the first frame.

Both are pitch (up), yaw (to the right) and roll (clockwise) in degrees, and the growth of the focal length against the
left one's in percent.)doc");
    drift.def(
        "getRotation", [](const RigDrift& self) { return toPython(self.getRotation()); },
        "Returns the rotation of the right camera in rectified coordinates: its transpose times R2 is the new R2.");
    drift.def(
        "correct",
        [](const RigDrift& self, const StereoCalibration& calibration, const py::array& R2) {
        return self.correct(calibration, toMatrix(R2, "R2"));
        },
        py::arg("calibration"), py::arg("R2"), R"doc(
Returns the calibration as it is now.

calibration: that of the rectification.
R2: its rotation of the right camera.)doc");
}

} // namespace

void addStereoRig(py::module_& module)
{
    addCalibration(module);
    addRig(module);
    addDrift(module);
}
