// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_ROW_ALIGNMENT_HPP
#define OPENCV_HDPSTEREO_ROW_ALIGNMENT_HPP

#include "corner_matches.hpp"
#include "../base/image_frame.hpp"

namespace cv { namespace stereo { namespace hdp {

//! How far the rows of the right image are below those of the left one, in pixels, at a place from the image's centre:
//! what small rotations of a camera and another focal length make
struct RowModel
{
    static const int terms = 5;
    typedef Vec<double, terms> Coefficients;

    Coefficients coefficients;

    explicit RowModel(const Coefficients& c = Coefficients()) : coefficients(c) {}

    //! 1, x, y, x y, y^2: of every row, a straight line
    static Coefficients basis(Point2d p) { return Coefficients(1, p.x, p.y, p.x * p.y, p.y * p.y); }
    double at(Point2d fromCentre) const { return coefficients.dot(basis(fromCentre)); }

    //! The same about a point that is x to the right of the centre
    RowModel about(double x) const
    {
        RowModel model = *this;
        model.coefficients[0] += coefficients[1] * x;
        model.coefficients[2] += coefficients[3] * x;
        return model;
    }

    //! The same in the pixels of a layer
    RowModel ofLayer(int layer) const
    {
        const double scale = 1 << layer;
        const Coefficients& c = coefficients;
        return RowModel(Coefficients(c[0] / scale, c[1], c[2], c[3] * scale, c[4] * scale));
    }
};

//! Noise of a pair
struct LayerNoise
{
    double deviation; // standard deviation, in levels of 255
    int layer;        // that it was measured in

    CV_EXPORTS double ofLayer(int other) const;
};

//! How the rows of a pair lie
struct RowFindings
{
    RowModel rows;        // zero if matches do not tell
    bool hasRows = false; // whether the model is certain, and moves rows by enough to be applied

    // Of the last layer that was looked at, 0 if unknown
    double rowError = 0; // standard deviation of the matches' rows from a model of them, in pixels of the image
    LayerNoise noise = LayerNoise(); // what remains between windows of matches, in the tenth with the lowest one
};

/** Finds how the rows of the right image lie against those of the left one, from the matches of matchCoarsely(), which
are followed to the finest layer.
@param finestLayer The last layer that matches are followed to; one of 600000 pixels is fine enough.
@param maxOffset Maximum difference of a pixel's rows that is believed, in pixels of the image. */
CV_EXPORTS void estimateRows(const CoarseMatches& coarse, int finestLayer, int maxOffset, RowFindings& findings);

/** aligned(x, y) = right(x, y + model(x, y)), by cubic interpolation. Beyond the image are its first and last rows.
@param right CV_8U or CV_16U, any number of channels.
@param frame What the model is about: the image, or a larger one that it is a tile of. */
CV_EXPORTS void alignRows(const Mat& right, const RowModel& model, const ImageFrame& frame, Mat& aligned);

}}} // namespace cv::stereo::hdp

#endif
