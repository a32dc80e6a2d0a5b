// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef HDPSTEREO_SAMPLES_STEREO_VIEW_HPP
#define HDPSTEREO_SAMPLES_STEREO_VIEW_HPP

// What hdp_camera shows.

#include <cfloat>
#include <cstdlib>

#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/opencv_modules.hpp"
#include "opencv2/videoio.hpp"
#ifdef HAVE_OPENCV_HIGHGUI
#include "opencv2/highgui.hpp"
#endif

namespace hdp_samples {

using namespace cv;

//! An image as it is shown, in colors of 8 bit. Cameras and pictures may have grey levels, also in 16 bit and floats;
//! what is not finite is black.
inline Mat colorsOf(const Mat& image)
{
    Mat colors = image;
    if (image.depth() != CV_8U)
    {
        colors = Mat::zeros(image.size(), CV_8U);
        normalize(image, colors, 0, 255, NORM_MINMAX, CV_8U, abs(image) <= FLT_MAX);
    }
    if (colors.channels() != 3)
        cvtColor(colors, colors, colors.channels() == 1 ? COLOR_GRAY2BGR : COLOR_BGRA2BGR);
    return colors;
}

//! The left image beside its disparities, from blue (far) to orange (near)
inline Mat drawPicture(const Mat& left, const Mat& disparity, const cv::stereo::HDPTreeMatcher::Findings& findings,
                       const std::vector<String>& lines)
{
    const int smallest = findings.minDisparity, range = findings.numDisparities;
    Mat levels, colors, picture;
    disparity.convertTo(levels, CV_8U, 150. / range, 20 - 150. / range * smallest);
    applyColorMap(levels, colors, COLORMAP_TURBO);
    colors.setTo(Scalar::all(0), disparity < smallest);
    hconcat(colorsOf(left), colors, picture);
    const double size = std::max(picture.cols / 1280., 0.4);
    for (size_t i = 0; i < lines.size(); i++)
    {
        const Point origin(cvRound(12 * size), cvRound(30 * size * (i + 1)));
        for (const bool isOutline : { true, false })
            putText(picture, lines[i], origin, FONT_HERSHEY_SIMPLEX, size, Scalar::all(isOutline ? 0 : 255),
                    cvRound(isOutline ? 4 * size + 1 : size), LINE_AA);
    }
    return picture;
}

//! Time per frame, and flicker: how much disparities change from frame to frame where the image stands still
class FrameStatistics
{
public:
    void start() { timer_.start(); }

    void stop(const Mat& left, const Mat& disparity)
    {
        timer_.stop();
        Mat grey;
        cvtColor(colorsOf(left), grey, COLOR_BGR2GRAY);
        GaussianBlur(grey, grey, Size(), 2);
        if (!lastGrey_.empty())
            addFlicker(grey, disparity);
        lastGrey_ = grey;
        lastDisparity_ = disparity.clone();
    }

    //! The next frame does not follow the last one.
    void interrupt() { lastGrey_.release(); }

    String text() const
    {
        const String time = timer_.getCounter() > 0 ? format("%.1f ms", timer_.getAvgTimeMilli()) : String("-");
        return frames_ > 0 ? time + format(", flicker %.2f px", flicker_) : time;
    }

private:
    //! A mean of the last frames
    void addFlicker(const Mat& grey, const Mat& disparity)
    {
        const double stillLevels = 3;
        const int meanOf = 20;
        Mat change, isStill;
        absdiff(grey, lastGrey_, change);
        isStill = change < stillLevels;
        absdiff(disparity, lastDisparity_, change);
        frames_ = std::min(frames_ + 1, meanOf);
        flicker_ += (mean(change, isStill)[0] - flicker_) / frames_;
    }

    TickMeter timer_;
    Mat lastGrey_, lastDisparity_;
    double flicker_ = 0;
    int frames_ = 0;
};

//! Where the pictures go: a window, a file, or neither
class Viewer
{
public:
    //! path: FILE.avi, or pictures by number (FILE%04d.png); empty for none
    Viewer(const String& path, bool wantsWindow) : path_(path), hasWindow_(wantsWindow && haveDisplay()) {}

    //! Returns the key that was pressed; -1 if there is none.
    int show(const Mat& picture, double fps)
    {
        if (!path_.empty() && !writer_.isOpened())
        {
            const bool isSequence = path_.find('%') != String::npos;
            const int codec = isSequence ? 0 : VideoWriter::fourcc('M', 'J', 'P', 'G');
            if (!writer_.open(path_, isSequence ? CAP_IMAGES : CAP_ANY, codec, isSequence ? 0 : fps, picture.size()))
                CV_Error(Error::StsError, "cannot write '" + path_ + "'");
        }
        if (!path_.empty())
            writer_.write(picture);
#ifdef HAVE_OPENCV_HIGHGUI
        if (hasWindow_)
        {
            imshow("hdp_camera", picture);
            return waitKey(1);
        }
#endif
        return -1;
    }

private:
    //! A window without a display may end the program, not just throw.
    static bool haveDisplay()
    {
#if defined HAVE_OPENCV_HIGHGUI && defined __unix__ && !defined __APPLE__
        return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY") || std::getenv("QT_QPA_PLATFORM");
#else
        return true;
#endif
    }

    const String path_;
    const bool hasWindow_;
    VideoWriter writer_;
};

} // namespace hdp_samples

#endif
