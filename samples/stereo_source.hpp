// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef HDPSTEREO_SAMPLES_STEREO_SOURCE_HPP
#define HDPSTEREO_SAMPLES_STEREO_SOURCE_HPP

// Pairs of images from where they are, for hdp_camera.

#include <cstdlib>

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/videoio.hpp"

namespace hdp_samples {

using namespace cv;

//! Images one after the other: of a file, a folder, or what cv::VideoCapture knows
class ImageSource
{
public:
    void open(const String& name)
    {
        if (utils::fs::isDirectory(name))
            glob(utils::fs::join(name, "*"), files_); // in the order of their names
        else if (haveImageReader(name))
            files_.push_back(name);
        else
        {
            const bool isCamera = !name.empty() && name.find_first_not_of("0123456789") == String::npos;
            const bool isFile = name.find_first_of("%!:") == String::npos; // no pattern, pipeline or address
            if (isCamera ? !capture_.open(std::atoi(name.c_str()))
                         : (isFile && !utils::fs::exists(name)) || !capture_.open(name))
                CV_Error(Error::StsError, "cannot open the " + String(isCamera ? "camera " : "source ") + name);
        }
    }

    bool grab() { return capture_.isOpened() ? capture_.grab() : next_ < files_.size(); }

    bool retrieve(Mat& image)
    {
        if (capture_.isOpened())
            return capture_.retrieve(image);
        image = imread(files_[next_], IMREAD_ANYCOLOR | IMREAD_ANYDEPTH);
        if (image.empty())
            CV_Error(Error::StsError, "cannot read the image '" + files_[next_] + "'");
        next_++;
        return true;
    }

    //! Of pictures; 0 if they are not counted beforehand
    size_t count() const { return files_.size(); }

    double fps() const
    {
        const double fps = capture_.get(CAP_PROP_FPS);
        return fps >= 1 && fps <= 1000 ? fps : 25; // cameras and pictures may not know
    }

private:
    VideoCapture capture_;
    std::vector<String> files_;
    size_t next_ = 0;
};

//! Where the pairs come from
class StereoSource
{
public:
    //! right: empty if the left source has both images side by side; rightFirst: then the right one is the left half
    StereoSource(const String& left, const String& right, bool rightFirst)
        : sideBySide_(right.empty()), rightFirst_(rightFirst)
    {
        left_.open(left);
        if (!sideBySide_)
            right_.open(right);
        if (left_.count() > 0 && right_.count() > 0 && left_.count() != right_.count()) // one is missing somewhere
            CV_Error_(Error::StsError, ("%s has %d images, and %s has %d", left.c_str(), (int)left_.count(),
                                        right.c_str(), (int)right_.count()));
    }

    //! Returns false at the end.
    bool read(Mat& left, Mat& right)
    {
        // Both are grabbed before one is decoded, so that two cameras see the same moment.
        if (!left_.grab() || (!sideBySide_ && !right_.grab()) || !left_.retrieve(frame_))
            return false;
        if (!sideBySide_)
        {
            left = frame_;
            return right_.retrieve(right);
        }
        const int half = frame_.cols / 2;
        left = frame_.colRange(0, half);
        right = frame_.colRange(half, 2 * half);
        if (rightFirst_)
            swap(left, right);
        return true;
    }

    double fps() const { return left_.fps(); }

private:
    const bool sideBySide_, rightFirst_;
    ImageSource left_, right_;
    Mat frame_;
};

} // namespace hdp_samples

#endif
