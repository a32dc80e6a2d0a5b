// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_MAP_FILTERS_HPP
#define OPENCV_HDPSTEREO_MAP_FILTERS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

// Filters of a disparity map, in the order in which they run. Each is in a file of its own.

//! Median of size x size pixels, 3, 5 or 7, borders replicated: faster than cv::medianBlur, which does not
//! share the work on a column of the window. disparity: CV_16UC1; filtered: another Mat.
CV_EXPORTS void medianDisparity(const Mat& disparity, int size, Mat& filtered);

/** Gives back what the median removed although it is more than noise: a pixel takes its disparity from before the
median if this is clearly nearer, and if many of the pixels in the window around it had about the same disparity.
@param unfiltered,disparity The maps before and after the median, CV_16UC1. */
CV_EXPORTS void restoreThinStructures(const Mat& unfiltered, Mat& disparity);

/** Moves the outlines of surfaces to the edges of the image: where disparities have a step, the pixels around vote for
one of its two surfaces. A weighted median @cite Ma2013WM of two surfaces is such a vote.

A step is where disparities of 3 x 3 pixels differ by more than 2 pixels; halfway between the nearest and the farthest
one is the border of the two surfaces. Each pixel of the window around that is on a surface, or at most a pixel beyond
its end, votes for it by max(36 - difference, 0), where difference is the largest one of a channel from that of the
pixel in the middle. The window has 16 columns, of which 7 are on the left of the pixel, all of them inside of the
image, and every third one of 13 rows, the nearest ones of the image. A pixel whose surface has fewer votes than the
other one gets the nearest or the farthest disparity of the 3 x 3.

In bars of up to 8 pixels the nearer surface keeps its pixels: these are fewer than those around.
@param image CV_8UC1 or CV_8UC3.
@param disparity CV_16UC1, a disparity map; USHRT_MAX has no vote, and what is voted beside it means nothing.
@param voted Receives another map, the same one if it has less than 16 columns. */
CV_EXPORTS void voteAtEdges(const Mat& image, const Mat& disparity, Mat& voted);

/** Smooths each surface by itself. The variance of a disparity's fraction is that of the noise over the sum of the
squared slopes around it @cite Kanade1994Adaptive: a pixel with texture stays as it is, one without takes over what
is on both sides of it. The precision of a pixel is the sum over 7 x 7 pixels of (slope / noise)^2 - 1/2, at least 1,
the slope being half the difference of the grey levels on both sides, and the half what noise alone has.

Each pixel becomes a mean of itself and pairs of opposite pixels, as in a sigma filter @cite Lee1983Sigma: those 1, 2
and 4 pixels away in the row, if neither differs from it by more than a surface's do, so that slopes and outlines stay
as they are. It has its precision for a weight, both of a pair the lower one of theirs, at most 64 over the square of
the distance. The same follows in the columns, and both again for pixels 3, 6 and 12 away. There are none beyond the
map.
@param levels Grey levels, CV_16UC1 in 1 / greyScale.
@param noise Standard deviation of the grey levels; half a level at least counts.
@param mostDifference Of the disparities of a surface.
@param disparity CV_16UC1; at most 4094 pixels. USHRT_MAX changes no other pixel.
@param smoothed Receives the map; another one. */
CV_EXPORTS void smoothSurfaces(const Mat& levels, double noise, int mostDifference, const Mat& disparity,
                               Mat& smoothed);

// What the rows of voteAtEdges() and smoothSurfaces() are computed with

//! What is around a row of voteAtEdges(), and how pixels vote
struct VoteRows
{
    static const int columns = 16, columnsBefore = 7, rows = 5, rowStep = 3; // of the window
    static const int barWidth = 8;                                           // pixels, up to which a surface is a bar
    static const int maxChannels = 3;

    const uchar* colour[maxChannels][rows];      // of the window
    const ushort* disparities[2 * barWidth + 1]; // of the rows up to barWidth away
    int channels;                                // of the colours: 1 or maxChannels
    int width;
    ushort likeness;       // the difference of colours from which on votes count nothing
    ushort minStep, reach; // of disparities: what is a step, and how far beyond its ends the surfaces go

    CV_ALWAYS_INLINE const ushort* disparity(int dy) const { return disparities[barWidth + dy]; }
};

const int precisionSide = 7; // pixels, of the window that a precision is a sum of

//! How slopes are counted, in 1 / perNoise of the noise
struct SlopeScale
{
    static const int perNoise = 8;
    static const int most = 36; // the sum of as many squares as there are in a window is below 2^16
    ushort mostChange, factor;  // of grey levels: the most that counts; of a slope over that change, in 1 / 256
};

//! The pairs of a pass
struct SmoothingPairs
{
    static const int count = 3;
    ptrdiff_t step;       // in memory, from the pixel to those of the first pair; each other pair is twice as far
    ushort limits[count]; // of their weights
    ushort like;          // the most that disparities of a surface differ
};

}}} // namespace cv::stereo::hdp

#endif
