// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A libFuzzer target: calibration files made of the fuzzer's bytes, and rigs of what they say. Besides what the
// sanitizers find, it stops if
// - something else is thrown than a cv::Exception of one line,
// - a rig does not keep its size, or its depth is not above 0,
// - the same files give another rig.
#include "opencv2/hdpstereo.hpp"

#include "../src/rig/calibration_text.hpp"
#include "input.hpp"

#include <cmath>

using namespace cv;
using namespace cv::stereo;

namespace {

const char* const files[][2] = {
    { "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 30., 0., 16., 0., 30., 12., "
      "0.,\n"
      "       0., 1. ]\nD1: !!opencv-matrix\n   data: [ -0.3, 0.1, 0., 0., 0.01 ]\nM2: !!opencv-matrix\n"
      "   data: [ 30., 0., 16., 0., 30., 12., 0., 0., 1. ]\nD2: !!opencv-matrix\n   data: [ -0.3, 0.1, 0., 0., 0.01 "
      "]\n",
      "%YAML:1.0\n---\nR: !!opencv-matrix\n   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]\nT: !!opencv-matrix\n"
      "   data: [ -0.1, 0., 0. ]\n" },
    { "image_width: 32\nimage_height: 24\ncamera_matrix:\n  rows: 3\n  data: [30, 0, 16, 0, 30, 12, 0, 0, 1]\n"
      "distortion_model: plumb_bob\ndistortion_coefficients:\n  data: [-0.3, 0.1, 0, 0, 0]\nrectification_matrix:\n"
      "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n  data: [30, 0, 16, 0, 0, 30, 12, 0, 0, 0, 1, 0]\n",
      "image_width: 32\nimage_height: 24\ncamera_matrix:\n  rows: 3\n  data: [30, 0, 16, 0, 30, 12, 0, 0, 1]\n"
      "distortion_model: plumb_bob\ndistortion_coefficients:\n  data: [-0.3, 0.1, 0, 0, 0]\nrectification_matrix:\n"
      "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n  data: [30, 0, 16, -3, 0, 30, 12, 0, 0, 0, 1, 0]\n" },
    { "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]\n  distortion_model: equidistant\n"
      "  intrinsics: [15, 15, 16, 12]\n  resolution: [32, 24]\ncam1:\n  T_cn_cnm1:\n  - [1, 0, 0, -0.1]\n"
      "  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n  camera_model: pinhole\n"
      "  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]\n  distortion_model: equidistant\n  intrinsics: [15, 15, 16, 12]\n"
      "  resolution: [32, 24]\n",
      "" },
    { "%YAML:1.0\n# General\nsensor_type: camera\nT_BS:\n  cols: 4\n  data: [1, 0, 0, 0, 0, 1, 0, 0,\n 0, 0, 1, 0, 0, "
      "0, 0, 1]\n"
      "resolution: [32, 24]\ncamera_model: pinhole\nintrinsics: [30, 30, 16, 12] #fu\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [-0.3, 0.1, 0, 0]\n",
      "%YAML:1.0\nsensor_type: camera\nT_BS:\n  cols: 4\n  data: [1, 0, 0, 0.1, 0, 1, 0, 0,\n 0, 0, 1, 0, 0, 0, 0, 1]\n"
      "resolution: [32, 24]\ncamera_model: pinhole\nintrinsics: [30, 30, 16, 12] #fu\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [-0.3, 0.1, 0, 0]\n" },
    { "[LEFT_CAM_VGA]\nfx=350\nfy=350\ncx=336\ncy=188\nk1=-0.2\nk2=0.1\np1=0\np2=0\nk3=0\n[RIGHT_CAM_VGA]\nfx=350\nfy="
      "350\n"
      "cx=336\ncy=188\nk1=-0.2\nk2=0.1\np1=0\np2=0\nk3=0\n[STEREO]\nBaseline=120\nTY=0\nTZ=0\nCV_VGA=0\nRX_VGA=0\nRZ_"
      "VGA=0\n",
      "" },
};

bool areEqual(const Mat& a, const Mat& b) { return a.size() == b.size() && norm(a, b, NORM_INF) == 0; }

StereoCalibration read(const std::string& first, const std::string& second, Size size)
{
    std::vector<hdp::CalibrationText> texts(1, hdp::CalibrationText("first", first));
    if (!second.empty())
        texts.push_back(hdp::CalibrationText("second", second));
    return hdp::toCalibration(texts, size, 1);
}

void checkRig(Input& input, const StereoCalibration& calibration)
{
    const Size size(input.ConsumeIntegralInRange(1, 40), input.ConsumeIntegralInRange(1, 40));
    const Ptr<StereoRig> rig = StereoRig::create(calibration, input.ConsumeBool() ? 0 : anyDouble(input), size);
    Mat left, right, mask, otherMask, depth, R1, R2, P1, P2, Q;
    rig->getMasks(mask, otherMask);
    require(mask.size() == size && otherMask.size() == size && rig->getSize() == size, "masks of another size");
    if (calibration.imageSize.area() < 1000000)
    {
        const Mat raw(calibration.imageSize, CV_8U, Scalar(255));
        rig->rectify(raw, raw, left, right);
        require(areEqual(left, mask) && areEqual(right, otherMask), "masks are not what is empty");
    }
    rig->computeDepth(Mat(1, 1, CV_32F, Scalar(1)), depth);
    require(depth.at<float>(0) > 0, "no depth");
    rig->getRectification(R1, R2, P1, P2, Q);
    require(checkRange(P2) && checkRange(Q) && checkRange(R1), "a rectification that is not finite");
    const Ptr<StereoRig> again = StereoRig::create(rig->getCalibration());
    require(again->getBaseline() == rig->getBaseline(), "another baseline");
    const Ptr<RigDrift> drift = RigDrift::create(P2, Size(640, 480), input.ConsumeIntegralInRange(1, 5));
    for (int i = 0; i < 4; ++i)
        drift->add({ anyDouble(input), anyDouble(input), anyDouble(input), anyDouble(input), anyDouble(input) });
    const StereoCalibration corrected = drift->correct(rig->getCalibration(), R2);
    require(checkRange(corrected.R) && checkRange(corrected.T), "a correction that is not finite");
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***);
extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    return silenceErrors();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Input input(data, size);
    const auto& kind = files[input.ConsumeIntegralInRange<size_t>(0, sizeof(files) / sizeof(files[0]) - 1)];
    const std::string first = mutated(input, kind[0]), second = mutated(input, kind[1]);
    const Size sizes[] = { Size(), Size(32, 24), Size(64, 48), Size(672, 376), Size(7, 3) };
    const Size imageSize = pick(input, sizes);
    try
    {
        const StereoCalibration calibration = read(first, second, imageSize);
        require(areEqual(calibration.R, read(first, second, imageSize).R), "the same files, another rig");
        checkRig(input, calibration);
    }
    catch (const cv::Exception& e)
    {
        require(e.err.find('\n') == std::string::npos && !e.err.empty(), "an error that is no sentence");
    }
    return 0;
}
