// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "calibration_check.hpp"
#include "calibration_text.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef std::vector<CalibrationText> Texts;

struct Camera
{
    Size size;
    Matx33d matrix;
    std::vector<double> distortion;
    bool isFisheye;
    CameraNames names;
};

std::string nameOf(const CalibrationText& text, const std::string& path) { return "'" + text.file() + "': " + path; }

//! Of a field that both cameras have in a file of their own
std::string nameOf(const Texts& texts, const std::string& path)
{
    return "'" + texts[0].file() + "' with " + nameOf(texts[1], path);
}

Matx33d cameraMatrix(double fx, double fy, double cx, double cy) { return Matx33d(fx, 0, cx, 0, fy, cy, 0, 0, 1); }

//! The width or the height of images, from a field of the text
int sideOf(const CalibrationText& text, double value, const std::string& path)
{
    const int side = saturate_cast<int>(value);
    if (!isPossible(Size(side, side)) || side != value)
        text.fail(path, "whole, from 1 to 32766");
    return side;
}

//! text, rotation, translation: what exceptions name
StereoCalibration join(const CalibrationText& text, const Camera& left, const Camera& right, const Matx33d& R,
                       const Vec3d& T, const std::string& rotation, const std::string& translation)
{
    if (left.size != right.size)
        CV_Error(Error::StsParseError,
                 format("'%s': the right camera has images of %d x %d pixels, the left one of %d x %d",
                        text.file().c_str(), right.size.width, right.size.height, left.size.width, left.size.height));
    if (left.isFisheye != right.isFisheye)
        CV_Error(Error::StsParseError, "'" + text.file() + "': one camera is a fisheye, the other one is not");
    StereoCalibration calibration;
    calibration.imageSize = left.size;
    calibration.cameraMatrix1 = Mat(left.matrix, true);
    calibration.distCoeffs1 = Mat(left.distortion, true);
    calibration.cameraMatrix2 = Mat(right.matrix, true);
    calibration.distCoeffs2 = Mat(right.distortion, true);
    calibration.R = Mat(R, true);
    calibration.T = Mat(T, true);
    calibration.isFisheye = left.isFisheye;
    checkCalibration({ "imageSize", { left.names, right.names }, rotation, translation }, calibration);
    return calibration;
}

//! A pose as a matrix of 4 x 4
void readPose(const CalibrationText& text, const std::string& path, Matx33d& R, Vec3d& T)
{
    const std::vector<double> values = text.numbers(path, 16);
    const Matx44d pose(values.data());
    if (pose.row(3) != Matx14d(0, 0, 0, 1))
        text.fail(path, "a pose, with 0, 0, 0, 1 in its last row");
    R = pose.get_minor<3, 3>(0, 0);
    if (!isRotation(R))
        text.fail(path, "a pose, with a rotation in its upper left 3 x 3");
    T = Vec3d(pose(0, 3), pose(1, 3), pose(2, 3));
}

//! Model and coefficients under the names that Kalibr, EuRoC and ROS have for them
void readDistortion(const CalibrationText& text, const std::string& model, const std::string& coefficients,
                    Camera& camera)
{
    const std::string name = text.word(model);
    camera.isFisheye = name == "equidistant" || name == "fisheye";
    const bool hasFour = camera.isFisheye || name == "radtan" || name == "radial-tangential";
    if (!hasFour && name != "plumb_bob" && name != "rational_polynomial" && name != "none")
        text.fail(model,
                  "one of plumb_bob, rational_polynomial, radtan, radial-tangential, equidistant and none, not '" +
                      name + "'");
    if (name != "none")
        camera.distortion = text.numbers(coefficients, hasFour ? 4 : 0);
    if (camera.distortion.empty()) // also of images that are rectified
        camera.distortion.resize(4);
}

//! What Kalibr and EuRoC have in common
Camera readPinhole(const CalibrationText& text, const std::string& camera, const std::string& coefficients)
{
    if (text.word(camera + "camera_model") != "pinhole")
        text.fail(camera + "camera_model", "pinhole, not '" + text.word(camera + "camera_model") + "'");
    Camera result;
    const std::string resolution = camera + "resolution";
    const std::vector<double> size = text.numbers(resolution, 2);
    result.size = Size(sideOf(text, size[0], resolution), sideOf(text, size[1], resolution));
    const std::vector<double> in = text.numbers(camera + "intrinsics", 4);
    result.matrix = cameraMatrix(in[0], in[1], in[2], in[3]);
    readDistortion(text, camera + "distortion_model", camera + coefficients, result);
    const std::string name = nameOf(text, camera + "intrinsics");
    result.names = { name, name, nameOf(text, camera + coefficients) };
    return result;
}

StereoCalibration readKalibr(const CalibrationText& text)
{
    const Camera left = readPinhole(text, "cam0/", "distortion_coeffs");
    const Camera right = readPinhole(text, "cam1/", "distortion_coeffs");
    Matx33d R;
    Vec3d T;
    const std::string path = "cam1/T_cn_cnm1";
    readPose(text, path, R, T);
    return join(text, left, right, R, T, nameOf(text, path), nameOf(text, path));
}

StereoCalibration readEuroc(const Texts& texts)
{
    Camera cameras[2];
    Matx33d R[2]; // from the camera to the body
    Vec3d T[2];
    std::string path; // of the pose
    for (int i = 0; i < 2; ++i)
    {
        cameras[i] = readPinhole(texts[i], "", "distortion_coefficients");
        path = texts[i].has("T_BS/data") || !texts[i].has("T_BS") ? "T_BS/data" : "T_BS";
        readPose(texts[i], path, R[i], T[i]);
    }
    return join(texts[1], cameras[0], cameras[1], R[1].t() * R[0], R[1].t() * (T[0] - T[1]), nameOf(texts, path),
                nameOf(texts, path));
}

StereoCalibration readRos(const Texts& texts)
{
    Camera cameras[2];
    Matx33d R[2]; // rectification
    double offsets[2];
    for (int i = 0; i < 2; ++i)
    {
        const CalibrationText& text = texts[i];
        Camera& camera = cameras[i];
        camera.size.width = sideOf(text, text.number("image_width"), "image_width");
        camera.size.height = sideOf(text, text.number("image_height"), "image_height");
        camera.matrix = Matx33d(text.numbers("camera_matrix/data", 9).data());
        readDistortion(text, "distortion_model", "distortion_coefficients/data", camera);
        R[i] = Matx33d(text.numbers("rectification_matrix/data", 9).data());
        if (!isRotation(R[i]))
            text.fail("rectification_matrix/data", "a rotation");
        const std::vector<double> P = text.numbers("projection_matrix/data", 12);
        if (!(P[0] > 0))
            text.fail("projection_matrix/data", "of a focal length above 0");
        offsets[i] = P[3] / P[0];
        const std::string name = nameOf(text, "camera_matrix/data");
        camera.names = { name, name, nameOf(text, "distortion_coefficients/data") };
    }
    if (std::abs(offsets[1] - offsets[0]) < leastBaseline) // of the rig, which has no field of its own
        texts[1].fail("projection_matrix/data", "of a baseline above 0, times -fx as fourth number");
    return join(texts[1], cameras[0], cameras[1], R[1].t() * R[0], R[1].t() * Vec3d(offsets[1] - offsets[0], 0, 0),
                nameOf(texts, "rectification_matrix/data"), nameOf(texts, "projection_matrix/data"));
}

//! Each matrix is in one of the texts: M1 and so on.
const CalibrationText& textWith(const Texts& texts, const std::string& name)
{
    const bool isUsuallySecond = name == "R" || name == "T";
    const bool isSecond = texts.size() > 1 && (texts[1].has(name) || (!texts[0].has(name) && isUsuallySecond));
    return texts[isSecond ? 1 : 0];
}

StereoCalibration readOpenCV(const Texts& texts, Size imageSize, double unit)
{
    if (imageSize.empty())
        CV_Error(Error::StsBadArg, "imageSize must be given: '" + texts[0].file() + "' does not have it");
    Camera cameras[2];
    for (int i = 0; i < 2; ++i)
    {
        const std::string K = i ? "M2" : "M1", D = i ? "D2" : "D1", model = "fisheye_model";
        const CalibrationText &textOfK = textWith(texts, K), &textOfD = textWith(texts, D),
                              &textOfModel = textWith(texts, model);
        Camera& camera = cameras[i];
        camera.size = imageSize;
        camera.matrix = Matx33d(textOfK.numbers(K + "/data", 9).data());
        camera.distortion = textOfD.numbers(D + "/data", 0);
        camera.isFisheye = textOfModel.has(model) && textOfModel.number(model) != 0;
        const std::string name = nameOf(textOfK, K + "/data");
        camera.names = { name, name, nameOf(textOfD, D + "/data") };
        const Point2d offset(camera.matrix(0, 2) / imageSize.width - 0.5, camera.matrix(1, 2) / imageSize.height - 0.5);
        if (std::max(std::abs(offset.x), std::abs(offset.y)) > 0.25)
            textOfK.fail(K, format("of a principal point near the middle: is it for images of %d x %d pixels?",
                                   imageSize.width, imageSize.height));
    }
    const CalibrationText &textOfR = textWith(texts, "R"), &textOfT = textWith(texts, "T");
    const Vec3d T = unit * Vec3d(textOfT.numbers("T/data", 3).data());
    return join(texts[0], cameras[0], cameras[1], Matx33d(textOfR.numbers("R/data", 9).data()), T,
                nameOf(textOfR, "R/data"), nameOf(textOfT, "T/data"));
}

//! Sections of the ZED's files, by the size of the images
struct ZedMode
{
    const char* name;
    Size size;
};

const ZedMode zedModes[] = { { "2K", Size(2208, 1242) }, { "FHD", Size(1920, 1080) },     { "HD", Size(1280, 720) },
                             { "VGA", Size(672, 376) },  { "FHD1200", Size(1920, 1200) }, { "SVGA", Size(960, 600) },
                             { "4K", Size(3840, 2160) }, { "QHDPLUS", Size(3200, 1800) } };

bool haveSameAspect(Size a, Size b)
{
    // A pixel may be cut off.
    return std::abs((double)a.width * b.height / b.width - a.height) <= 1;
}

//! The mode of this size; otherwise that which it is a half, a quarter or an eighth of, or else the only one of its
//! aspect: modes see different parts of the sensor.
const ZedMode& zedModeOf(const CalibrationText& text, Size imageSize)
{
    const auto has = [&](const ZedMode& mode) { return text.has(std::string("LEFT_CAM_") + mode.name + "/FX"); };
    for (int halved = 1; halved <= 8; halved *= 2)
        for (const ZedMode& mode : zedModes)
            if (imageSize == Size(mode.size.width / halved, mode.size.height / halved) && has(mode))
                return mode;
    const auto isLike = [&](const ZedMode& mode) { return haveSameAspect(imageSize, mode.size) && has(mode); };
    if (std::count_if(std::begin(zedModes), std::end(zedModes), isLike) == 1)
        return *std::find_if(std::begin(zedModes), std::end(zedModes), isLike);
    std::string names;
    for (const ZedMode& mode : zedModes)
        if (has(mode))
            names += format("%s%d x %d", names.empty() ? "" : ", ", mode.size.width, mode.size.height);
    if (names.empty())
        text.fail("LEFT_CAM_HD/FX", "the focal length of the left camera");
    CV_Error(Error::StsBadArg, format("imageSize must be that of one camera: '%s' is for %s, not %d x %d",
                                      text.file().c_str(), names.c_str(), imageSize.width, imageSize.height));
}

Camera readZedCamera(const CalibrationText& text, const std::string& side, const ZedMode& mode)
{
    const std::string section = side + "_CAM_" + mode.name + "/";
    const std::string distortion =
        text.has(section + "K1") || !text.hasBelow(side + "_DISTO/") ? section : side + "_DISTO/";
    Camera camera;
    camera.size = mode.size;
    camera.matrix = cameraMatrix(text.number(section + "FX"), text.number(section + "FY"), text.number(section + "CX"),
                                 text.number(section + "CY"));
    camera.isFisheye = distortion != section && !text.has(distortion + "P1");
    camera.names = { nameOf(text, section + "FX, FY"), nameOf(text, section + "CX, CY"), nameOf(text, distortion) };
    typedef std::vector<const char*> Names;
    const Names all =
        camera.isFisheye ? Names{ "K1", "K2", "K3", "K4" } : Names{ "K1", "K2", "P1", "P2", "K3", "K4", "K5", "K6" };
    for (const char* name : all)
    {
        if (camera.distortion.size() >= 5 && !text.has(distortion + name)) // those of a rational model
            continue;
        camera.names.distortion += std::string(camera.distortion.empty() ? "" : ", ") + name;
        camera.distortion.push_back(text.number(distortion + name));
    }
    return camera;
}

//! The vendor's open drivers give cv::stereoRectify a positive baseline, of which it takes either sign.
//! StereoCalibration has the translation from left to right coordinates, which is negative, in metres.
StereoCalibration readZed(const CalibrationText& text, Size imageSize)
{
    if (imageSize.empty())
        CV_Error(Error::StsBadArg, "imageSize must be given: '" + text.file() + "' is for cameras of several sizes");
    const ZedMode& mode = zedModeOf(text, imageSize);
    const Camera left = readZedCamera(text, "LEFT", mode), right = readZedCamera(text, "RIGHT", mode);
    const auto stereo = [&](const std::string& name) {
        const std::string ofMode = "STEREO/" + name + "_" + mode.name;
        return text.number(text.has(ofMode) || !text.has("STEREO/" + name) ? ofMode : "STEREO/" + name);
    };
    const Vec3d rotation(stereo("RX"), stereo("CV"), stereo("RZ")); // CV: convergence, about y
    const Vec3d millimetres(text.number("STEREO/BASELINE"), stereo("TY"), stereo("TZ"));
    Matx33d R;
    Rodrigues(rotation, R);
    return join(text, left, right, R, -1e-3 * millimetres, nameOf(text, "STEREO/RX, CV, RZ"),
                nameOf(text, "STEREO/BASELINE, TY, TZ"));
}

//! Whether the texts have one of these fields, and so are of a kind. Throws if that has another number of files.
bool areOf(const char* kind, size_t files, const Texts& texts, const std::vector<const char*>& prefixes)
{
    bool hasAny = false;
    for (const CalibrationText& text : texts)
        for (const char* prefix : prefixes)
            hasAny = hasAny || text.hasBelow(prefix);
    if (hasAny && texts.size() != files)
        CV_Error(Error::StsBadArg,
                 "'" + texts[0].file() + "' is of " + kind + ", which has " +
                     (files == 1 ? "one file for both cameras" : "a file for each camera: second must be given"));
    return hasAny;
}

StereoCalibration readKind(const Texts& texts, Size imageSize, double unit)
{
    if (areOf("the ZED", 1, texts, { "LEFT_CAM_", "RIGHT_CAM_", "STEREO/" }))
        return readZed(texts[0], imageSize);
    if (areOf("Kalibr", 1, texts, { "cam0/", "cam1/" }))
        return readKalibr(texts[0]);
    if (areOf("ROS", 2, texts, { "camera_matrix", "rectification_matrix", "projection_matrix" }))
        return readRos(texts);
    if (areOf("EuRoC", 2, texts, { "T_BS", "sensor_type", "intrinsics" }))
        return readEuroc(texts);
    if (areOf("OpenCV", texts.size(), texts, { "M1/", "D1/", "M2/", "D2/", "R/", "T/" })) // one or two
        return readOpenCV(texts, imageSize, unit);
    CV_Error(Error::StsParseError,
             "'" + texts[0].file() + "' is no calibration of OpenCV, ROS, Kalibr, EuRoC or the ZED that is known");
}

CalibrationText readText(const std::string& file)
{
    const size_t maxBytes = 1 << 20; // calibrations have a few thousand
    std::ifstream stream(file.c_str(), std::ios::binary);
    std::string text(maxBytes + 1, '\0');
    stream.read(&text[0], (std::streamsize)text.size());
    text.resize((size_t)std::max<std::streamsize>(stream.gcount(), 0));
    if (text.empty())
        CV_Error(Error::StsObjectNotFound, "cannot read the calibration '" + file + "'");
    if (text.size() > maxBytes)
        CV_Error(Error::StsParseError, "'" + file + "' is too large for a calibration");
    return CalibrationText(file, text);
}

} // namespace

StereoCalibration toCalibration(const Texts& texts, Size size, double unit)
{
    StereoCalibration calibration = readKind(texts, size, unit);
    if (size.empty())
        return calibration;
    const Size old = calibration.imageSize;
    if (!haveSameAspect(size, old))
        CV_Error(Error::StsBadArg, format("'%s' is for images of %d x %d pixels: those of %d x %d have another aspect",
                                          texts[0].file().c_str(), old.width, old.height, size.width, size.height));
    const double x = (double)size.width / old.width, y = (double)size.height / old.height;
    const Matx33d scaling(x, 0, 0.5 * x - 0.5, 0, y, 0.5 * y - 0.5, 0, 0, 1); // pixels are around whole numbers
    for (Mat* matrix : { &calibration.cameraMatrix1, &calibration.cameraMatrix2 })
        *matrix = Mat(scaling * Matx33d(*matrix), true);
    calibration.imageSize = size;
    return calibration;
}

}}} // namespace cv::stereo::hdp

cv::stereo::StereoCalibration cv::stereo::readStereoCalibration(const String& first, const String& second,
                                                                Size imageSize, double unit)
{
    CV_TRACE_FUNCTION();
    if (imageSize != Size() && !hdp::isPossible(imageSize))
        CV_Error(Error::StsOutOfRange, "imageSize must be from 1 x 1 to 32766 x 32766, or not given");
    if (!(unit > 0 && unit <= 1e6))
        CV_Error(Error::StsOutOfRange, "unit must be above 0, and not above 1000000");
    std::vector<hdp::CalibrationText> texts(1, hdp::readText(first));
    if (!second.empty())
        texts.push_back(hdp::readText(second));
    return hdp::toCalibration(texts, imageSize, unit);
}
