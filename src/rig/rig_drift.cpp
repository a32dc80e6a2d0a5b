// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "calibration_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cv { namespace stereo {

namespace {

HDP_TUNABLE(double, frameDeviation, 0.03, "pixels",
            "of the rows that one frame tells, until frames tell it themselves");
HDP_TUNABLE(double, modelDeviation, 0.02, "pixels", "of rows in the mean of any number of frames: lenses and matching");
HDP_TUNABLE(double, contradiction, 6, "deviations", "of a frame from those before");
HDP_TUNABLE(double, certainty, 2, "deviations", "of yaw and focal length, from which they are corrected");
const int maxContradictions = 5; // in a row
const int firstFrames = 5;       // are too few to contradict

enum
{
    PITCH, // in radians, as yaw and roll
    YAW,
    ROLL,
    GROWTH, // of the focal length, relative
    terms
};
typedef Vec<double, terms> Terms;

const int samples = 8; // places, along each side of the image
const int rowTerms = 5;

//! Rotation in rectified coordinates: x to the right, y down. Positive: up, to the right, clockwise.
Matx33d rotationOf(const Terms& turn)
{
    // Points of the image go the opposite way.
    Matx33d R;
    Rodrigues(Vec3d(-turn[PITCH], -turn[YAW], -turn[ROLL]), R);
    return R;
}

class RigDriftImpl CV_FINAL : public RigDrift
{
public:
    RigDriftImpl(const Matx33d& cameraMatrix, Size size, int memory)
        : K_(cameraMatrix), size_(size), memory_(memory), frames_(0), contradictions_(0)
    {
        for (int i = 0; i < samples * samples; ++i)
            places_.push_back(Point2d(((i % samples + 0.5) / samples - 0.5) * size.width,
                                      ((i / samples + 0.5) / samples - 0.5) * size.height));
        slopes_.resize(places_.size());
        const double step = 1e-5; // a small turn
        for (int term = 0; term < terms; ++term)
        {
            Terms turn;
            turn[term] = step;
            const std::vector<double> after = rowsAt(turn), before = rowsAt(-turn);
            for (size_t i = 0; i < places_.size(); ++i)
                slopes_[i][term] = (after[i] - before[i]) / (2 * step);
        }
        Matx<double, terms, terms> information;
        for (const Terms& slopes : slopes_)
            information += slopes * slopes.t();
        inverse_ = information.inv(DECOMP_SVD);
        for (int i = 0; i < terms; ++i)
            unit_[i] = std::sqrt(inverse_(i, i) * samples * samples);
    }

    bool add(const std::vector<double>& rows) CV_OVERRIDE
    {
        if (rows.size() != rowTerms || !checkRange(rows))
            CV_Error(Error::StsBadArg, "rows must be five finite numbers");
        for (const Point2d& place : places_)
            if (!(std::abs(rowOf(rows, place)) < 0.25 * size_.height))
                CV_Error(Error::StsOutOfRange, "rows must be off by less than a quarter of the image's height");
        if (std::count(rows.begin(), rows.end(), 0.) == rowTerms)
            return false;
        const Terms found = fit(rows);
        if (contradicts(found))
        {
            if (++contradictions_ < maxContradictions)
                return false;
            frames_ = 0;
        }
        contradictions_ = 0;
        const double count = std::min(++frames_, memory_); // 1: this frame is all that counts
        for (int i = 0; i < terms; ++i)
        {
            const double difference = found[i] - mean_[i];
            mean_[i] += difference / count;
            variance_[i] += (difference * difference * (count - 1) / count - variance_[i]) / count;
        }
        return true;
    }

    int getFrames() const CV_OVERRIDE { return frames_; }

    void getEstimate(std::vector<double>& values, std::vector<double>& deviations) const CV_OVERRIDE
    {
        const double degrees = 180 / CV_PI, units[] = { degrees, degrees, degrees, 100 };
        values.resize(terms);
        deviations.resize(terms);
        for (int i = 0; i < terms; ++i)
        {
            values[i] = mean_[i] * units[i];
            deviations[i] = standardDeviation(i) * units[i];
        }
    }

    Mat getRotation() const CV_OVERRIDE { return Mat(rotationOf(certainTerms()), true); }

    StereoCalibration correct(const StereoCalibration& calibration, InputArray R2Array) const CV_OVERRIDE
    {
        const Mat R2Mat = R2Array.getMat(), &R = calibration.R, &T = calibration.T;
        if (R2Mat.size() != Size(3, 3) || R2Mat.channels() != 1 || !hdp::isRotation(R2Mat))
            CV_Error(Error::StsBadArg, "R2 must be a rotation, 3 x 3");
        if (R.size() != Size(3, 3) || T.total() != 3 || R.type() != CV_64F || T.type() != CV_64F ||
            calibration.cameraMatrix2.size() != Size(3, 3) || calibration.cameraMatrix2.type() != CV_64F)
            CV_Error(Error::StsBadArg, "calibration must have R, T and cameraMatrix2 of CV_64F");
        const Terms turn = certainTerms();
        const Matx33d R2(R2Mat), turned = R2.t() * rotationOf(turn) * R2;
        StereoCalibration corrected = calibration;
        corrected.R = Mat(turned * Matx33d(R), true);
        corrected.T = Mat(turned * Vec3d(T), true); // the camera turns where it is
        corrected.cameraMatrix2 = calibration.cameraMatrix2.clone();
        corrected.cameraMatrix2.at<double>(0, 0) *= 1 + turn[GROWTH];
        corrected.cameraMatrix2.at<double>(1, 1) *= 1 + turn[GROWTH];
        return corrected;
    }

private:
    //! By how much lower points appear than they would without the turn. Places: the columns where they are, and the
    //! rows where they would be, as Findings::rows has them
    std::vector<double> rowsAt(const Terms& turn) const
    {
        const Matx33d backward = rotationOf(turn).t();
        const double growth = 1 + turn[GROWTH];
        std::vector<double> rows;
        for (const Point2d& place : places_)
        {
            const double x = place.x + 0.5 * (size_.width - 1), y = place.y + 0.5 * (size_.height - 1);
            double seen = y;
            for (int step = 0; step < 4; ++step)
            {
                const Vec3d ray((x - K_(0, 2)) / K_(0, 0) / growth, (seen - K_(1, 2)) / K_(1, 1) / growth, 1);
                const Vec3d before = backward * ray;
                seen += y - (K_(1, 1) * before[1] / before[2] + K_(1, 2));
            }
            rows.push_back(seen - y);
        }
        return rows;
    }

    //! By how much a point is below its row, of Findings::rows
    static double rowOf(const std::vector<double>& rows, const Point2d& place)
    {
        const double u = place.x, v = place.y;
        return rows[0] + rows[1] * u + rows[2] * v + rows[3] * u * v + rows[4] * v * v;
    }

    //! Least squares over the image
    Terms fit(const std::vector<double>& rows) const
    {
        Terms turn;
        for (int step = 0; step < 5; ++step) // a turn of a degree is nearly linear
        {
            const std::vector<double> explained = rowsAt(turn);
            Terms sum;
            for (size_t i = 0; i < places_.size(); ++i)
                sum += slopes_[i] * (rowOf(rows, places_[i]) - explained[i]);
            turn += inverse_ * sum;
        }
        return turn;
    }

    //! Of a term in the mean of so many frames. The first guess of how it varies counts as a frame.
    double deviationOf(int term, double frames) const
    {
        const double guess = unit_[term] * frameDeviation, model = unit_[term] * modelDeviation;
        const double frameVariance = variance_[term] + guess * guess / std::min(frames_, memory_);
        return std::sqrt(frameVariance / frames + model * model);
    }

    //! Of the mean of those that count
    double standardDeviation(int term) const
    {
        return frames_ ? deviationOf(term, std::min(frames_, memory_)) : std::numeric_limits<double>::infinity();
    }

    bool contradicts(const Terms& found) const
    {
        if (frames_ < firstFrames)
            return false;
        for (int i = 0; i < terms; ++i)
            if (std::abs(found[i] - mean_[i]) > contradiction * deviationOf(i, 1))
                return true;
        return false;
    }

    //! Pitch and roll are what rows tell; of the others only what is certain.
    Terms certainTerms() const
    {
        Terms turn = mean_;
        for (const int i : { YAW, GROWTH })
            if (std::abs(turn[i]) < certainty * standardDeviation(i))
                turn[i] = 0;
        return turn;
    }

    const Matx33d K_; // of the rectified camera
    const Size size_;
    const int memory_;
    std::vector<Point2d> places_; // from the image's centre
    std::vector<Terms> slopes_;   // of the places
    Matx<double, terms, terms> inverse_;
    Terms unit_; // standard deviation of a term, if rows have one of 1 pixel
    int frames_, contradictions_;
    Terms mean_, variance_; // of the frames
};

} // namespace

Ptr<RigDrift> RigDrift::create(InputArray P2, Size imageSize, int memory)
{
    const Mat P = P2.getMat();
    if (P.rows != 3 || (P.cols != 3 && P.cols != 4) || P.channels() != 1 || !checkRange(P))
        CV_Error(Error::StsBadArg, "P2 must be a projection, 3 x 3 or 3 x 4");
    Mat K;
    P.colRange(0, 3).convertTo(K, CV_64F);
    if (!(K.at<double>(0, 0) > 1 && K.at<double>(1, 1) > 1))
        CV_Error(Error::StsBadArg, "P2 must have focal lengths above 1 pixel");
    if (imageSize.width < 16 || imageSize.height < 16)
        CV_Error(Error::StsOutOfRange, "imageSize must be 16 x 16 or larger");
    if (memory < 1)
        CV_Error(Error::StsOutOfRange, "memory must be 1 or above");
    return makePtr<RigDriftImpl>(Matx33d(K), imageSize, memory);
}

}} // namespace cv::stereo
