// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_LIGHT_ALIGNMENT_HPP
#define OPENCV_HDPSTEREO_LIGHT_ALIGNMENT_HPP

#include "corner_matches.hpp"
#include "../base/image_frame.hpp"

namespace cv { namespace stereo { namespace hdp {

/** What the left camera sees of a level r of the right one at a place (x, y), from the centre in units of the width and
the height: gain, vignetting, offset, and the curve of the levels. Levels are 0 to 1. */
struct LightModel
{
    enum
    {
        gain, // terms of basis(); rim: the vignetting of corners
        gainX,
        gainY,
        gainXX,
        gainXY,
        gainYY,
        rim,
        offset,
        square,
        cube,
        terms
    };
    typedef Vec<double, terms> Coefficients;

    Coefficients coefficients = identity();

    static Coefficients identity() { return Coefficients(1, 0, 0, 0, 0, 0, 0, 0, 0, 0); }
    //! r times 1, x, y, x^2, x y, y^2 and (x^2 + y^2)^2; 1, r^2, r^3
    static Coefficients basis(double r, double x, double y)
    {
        const double distance2 = x * x + y * y;
        return Coefficients(r, r * x, r * y, r * x * x, r * x * y, r * y * y, r * distance2 * distance2, 1, r * r,
                            r * r * r);
    }
    double at(double r, double x, double y) const { return coefficients.dot(basis(r, x, y)); }
    //! The same for levels that are factor times as large
    LightModel scaled(double factor) const
    {
        LightModel model = *this;
        model.coefficients[offset] *= factor;
        model.coefficients[square] /= factor;
        model.coefficients[cube] /= factor * factor;
        return model;
    }
};

//! What gives a row of grey levels other light: of a level r at x = first + step * (origin + column), offset +
//! r (gain[0] + gain[1] x + gain[2] x^2 + gain[3] x^4 + square r + cube r^2), at most largest
struct RowLight
{
    float first, step;
    int origin;
    float gain[4], offset, square, cube, largest;
};

//! Finds how the light of the right image differs from that of the left one, from the mean levels around matched
//! corners: the identity if these do not tell. Returns whether the model explains what differs, and is worth applying.
CV_EXPORTS bool estimateLight(const CoarseMatches& coarse, LightModel& model);

/** Gives the right image the light of the left one.
@param levels CV_16UC1 of values up to whiteLevel, changed in place.
@param frame What the model is about: the image, or a larger one that it is a tile of. */
CV_EXPORTS void alignLight(Mat& levels, const LightModel& model, const ImageFrame& frame);

}}} // namespace cv::stereo::hdp

#endif
