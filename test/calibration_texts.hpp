// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_CALIBRATION_TEXTS_HPP
#define OPENCV_HDPSTEREO_TEST_CALIBRATION_TEXTS_HPP

#include "test_precomp.hpp"

namespace opencv_test {

//! Two cameras 120 mm apart, turned by some degrees against each other; coefficients: of the distortion, 4 with fisheye
inline StereoCalibration makeCalibration(int coefficients = 5, bool isFisheye = false)
{
    const double lens[] = { -0.28, 0.074, 0.0002,  -0.0003, 0.01,   0.02, -0.01,
                            0.003, 0.001, -0.0005, 0.0008,  0.0004, 0.01, -0.02 };
    const double fisheyeLens[] = { -0.02, 0.01, -0.005, 0.001 };
    StereoCalibration c;
    c.imageSize = Size(480, 360);
    c.cameraMatrix1 = (Mat_<double>(3, 3) << 402, 0, 236.5, 0, 401, 181.25, 0, 0, 1);
    c.cameraMatrix2 = (Mat_<double>(3, 3) << 399, 0, 242.5, 0, 400.5, 176.75, 0, 0, 1);
    c.distCoeffs1 = Mat(1, coefficients, CV_64F, const_cast<double*>(isFisheye ? fisheyeLens : lens)).clone();
    c.distCoeffs2 = 0.9 * c.distCoeffs1;
    Matx33d R;
    Rodrigues(Vec3d(0.012, -0.017, 0.008), R);
    c.R = Mat(R, true);
    c.T = Mat(-(R * Vec3d(0.12, 0.001, -0.002)), true);
    c.isFisheye = isFisheye;
    return c;
}

//! A field as it stands in a file
struct CalibrationField
{
    std::string path, text;
};

struct CalibrationFile
{
    std::string name;
    std::string head;
    std::vector<CalibrationField> fields;

    std::string text() const
    {
        std::string text = head;
        for (const CalibrationField& field : fields)
            text += field.text;
        return text;
    }
};

//! Numbers between commas
inline std::string inWords(const Mat& numbers)
{
    std::string words;
    for (int i = 0; i < (int)numbers.total(); ++i)
        words += (i ? ", " : "") + cv::format("%.12g", numbers.ptr<double>()[i]);
    return words;
}

inline Mat poseOf(const Mat& R, const Mat& T)
{
    Mat pose = Mat::eye(4, 4, CV_64F);
    R.copyTo(pose(Rect(0, 0, 3, 3)));
    Mat(T.reshape(1, 3)).copyTo(pose(Rect(3, 0, 1, 3)));
    return pose;
}

inline std::string intrinsicsOf(const Mat& K)
{
    return cv::format("%.12g, %.12g, %.12g, %.12g", K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2),
                      K.at<double>(1, 2));
}

inline std::vector<CalibrationFile> inOpenCVFiles(const StereoCalibration& c)
{
    const auto matrix = [](const std::string& name, const Mat& m) {
        return CalibrationField{
            name, name +
                      cv::format(": !!opencv-matrix\n   rows: %d\n   cols: %d\n   dt: d\n   data: [ ", m.rows, m.cols) +
                      inWords(m) + " ]\n"
        };
    };
    std::vector<CalibrationFile> files(2);
    files[0] = { "intrinsics.yml",
                 "%YAML:1.0\n---\n",
                 { matrix("M1", c.cameraMatrix1), matrix("D1", c.distCoeffs1), matrix("M2", c.cameraMatrix2),
                   matrix("D2", c.distCoeffs2) } };
    if (c.isFisheye)
        files[0].head += "fisheye_model: 1\n";
    files[1] = { "extrinsics.yml", "%YAML:1.0\n---\n", { matrix("R", c.R), matrix("T", c.T) } };
    return files;
}

inline std::vector<CalibrationFile> inRosFiles(const StereoCalibration& c)
{
    Mat R[2], P[2], Q;
    const Mat straight = Mat::zeros(1, 4, CV_64F);
    stereoRectify(c.cameraMatrix1, straight, c.cameraMatrix2, straight, c.imageSize, c.R, c.T, R[0], R[1], P[0], P[1],
                  Q);
    std::vector<CalibrationFile> files(2);
    for (int i = 0; i < 2; ++i)
    {
        const Mat &K = i ? c.cameraMatrix2 : c.cameraMatrix1, &D = i ? c.distCoeffs2 : c.distCoeffs1;
        const auto matrix = [](const std::string& name, const Mat& m) {
            return CalibrationField{ name, name + cv::format(":\n  rows: %d\n  cols: %d\n  data: [", m.rows, m.cols) +
                                               inWords(m) + "]\n" };
        };
        const char* const model = c.isFisheye ? "equidistant" : D.cols > 5 ? "rational_polynomial" : "plumb_bob";
        files[i] = { i ? "right.yaml" : "left.yaml",
                     "camera_name: narrow_stereo/left  # a comment: 1\n",
                     { { "image_width", cv::format("image_width: %d\n", c.imageSize.width) },
                       { "image_height", cv::format("image_height: %d\n", c.imageSize.height) },
                       matrix("camera_matrix", K),
                       { "distortion_model", cv::format("distortion_model: %s\n", model) },
                       matrix("distortion_coefficients", D),
                       matrix("rectification_matrix", R[i]),
                       matrix("projection_matrix", P[i]) } };
    }
    return files;
}

inline std::vector<CalibrationFile> inKalibrFile(const StereoCalibration& c)
{
    CalibrationFile file = { "camchain.yaml", "", {} };
    for (int i = 0; i < 2; ++i)
    {
        const Mat &K = i ? c.cameraMatrix2 : c.cameraMatrix1, &D = i ? c.distCoeffs2 : c.distCoeffs1;
        const std::string camera = i ? "cam1/" : "cam0/", model = c.isFisheye ? "equidistant" : "radtan";
        std::vector<CalibrationField> fields = {
            { camera + "camera_model", "  camera_model: pinhole\n" },
            { camera + "distortion_coeffs", "  distortion_coeffs: [" + inWords(D) + "]\n" },
            { camera + "distortion_model", "  distortion_model: " + model + "\n" },
            { camera + "intrinsics", "  intrinsics: [" + intrinsicsOf(K) + "]\n" },
            { camera + "resolution", cv::format("  resolution: [%d, %d]\n", c.imageSize.width, c.imageSize.height) }
        };
        fields[0].text = (i ? "cam1:\n  cam_overlaps: [0]\n" : "cam0:\n  cam_overlaps: [1]\n") + fields[0].text;
        fields.back().text += "  rostopic: /cam0/image_raw\n";
        if (i)
        {
            const Mat pose = poseOf(c.R, c.T);
            std::string text = "  T_cn_cnm1:\n";
            for (int row = 0; row < 4; ++row)
                text += "  - [" + inWords(pose.row(row).clone()) + "]\n";
            fields.push_back({ camera + "T_cn_cnm1", text });
        }
        file.fields.insert(file.fields.end(), fields.begin(), fields.end());
    }
    return { file };
}

inline std::vector<CalibrationFile> inEurocFiles(const StereoCalibration& c)
{
    std::vector<CalibrationFile> files(2);
    Matx33d bodyR;
    Rodrigues(Vec3d(0.3, -1.2, 0.8), bodyR);
    const Mat body = poseOf(Mat(bodyR, true), (Mat_<double>(3, 1) << -0.02, 0.5, 0.1)); // from the left camera
    for (int i = 0; i < 2; ++i)
    {
        const Mat &K = i ? c.cameraMatrix2 : c.cameraMatrix1, &D = i ? c.distCoeffs2 : c.distCoeffs1;
        const Mat pose = i ? Mat(body * poseOf(c.R, c.T).inv()) : body;
        const std::string model = c.isFisheye ? "equidistant" : "radial-tangential";
        files[i] = {
            i ? "cam1.yaml" : "cam0.yaml",
            "%YAML:1.0\n# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0 (MT9M034)\n\n",
            { { "T_BS", "T_BS:\n  cols: 4\n  rows: 4\n  data: [" + inWords(pose.rowRange(0, 2).clone()) + ",\n    " +
                            inWords(pose.rowRange(2, 4).clone()) + "]\n" },
              { "resolution", cv::format("resolution: [%d, %d]\n", c.imageSize.width, c.imageSize.height) },
              { "camera_model", "camera_model: pinhole\n" },
              { "intrinsics", "intrinsics: [" + intrinsicsOf(K) + "] #fu, fv, cu, cv\n" },
              { "distortion_model", "distortion_model: " + model + "\n" },
              { "distortion_coefficients", "distortion_coefficients: [" + inWords(D) + "]\n" } }
        };
    }
    return files;
}

//! The calibration is of 1280 x 720 pixels, with 5 or 8 coefficients.
inline std::vector<CalibrationFile> inZedFile(const StereoCalibration& c)
{
    CalibrationFile file = { "SN12345.conf", "", {} };
    const auto append = [&](const std::string& section, const std::string& key, double value) {
        std::string name = key;
        for (char& letter : name)
            letter = (char)std::toupper(letter);
        file.fields.push_back({ section + "/" + name, cv::format("%s=%.12g\n", key.c_str(), value) });
    };
    const char* const coefficients[] = { "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6" };
    for (int i = 0; i < 2; ++i)
    {
        const Mat &K = i ? c.cameraMatrix2 : c.cameraMatrix1, &D = i ? c.distCoeffs2 : c.distCoeffs1;
        const std::string section = i ? "RIGHT_CAM_HD" : "LEFT_CAM_HD";
        const size_t first = file.fields.size();
        append(section, "fx", K.at<double>(0, 0));
        append(section, "fy", K.at<double>(1, 1));
        append(section, "cx", K.at<double>(0, 2));
        append(section, "cy", K.at<double>(1, 2));
        for (int k = 0; k < D.cols; ++k)
            append(section, coefficients[k], D.at<double>(k));
        file.fields[first].text = "\n[" + section + "]\n" + file.fields[first].text;
    }
    Vec3d rotation;
    Rodrigues(c.R, rotation);
    const size_t first = file.fields.size();
    append("STEREO", "Baseline", -1000 * c.T.at<double>(0));
    append("STEREO", "TY", -1000 * c.T.at<double>(1));
    append("STEREO", "TZ", -1000 * c.T.at<double>(2));
    append("STEREO", "RX_HD", rotation[0]);
    append("STEREO", "CV_HD", rotation[1]);
    append("STEREO", "RZ_HD", rotation[2]);
    file.fields[first].text = "\n[STEREO]\n" + file.fields[first].text;
    return { file };
}

} // namespace opencv_test

#endif
