// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_EDGE_VOTE_HPP
#define OPENCV_HDPSTEREO_EDGE_VOTE_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is around a row of voteAtEdges(), and how pixels vote
struct VoteRows
{
    enum
    {
        columns = 16, // of the window
        columnsBefore = 7,
        rows = 5,
        rowStep = 3,
        barWidth = 8, // pixels, up to which a surface is a bar
        maxChannels = 3
    };
    const uchar* colour[maxChannels][rows];      // of the window
    const ushort* disparities[2 * barWidth + 1]; // of the rows up to barWidth away
    int channels;                                // of the colours: 1 or maxChannels
    int width;
    ushort likeness;       // the difference of colours from which on votes count nothing
    ushort minStep, reach; // of disparities: what is a step, and how far beyond its ends the surfaces go

    CV_ALWAYS_INLINE const ushort* disparity(int dy) const { return disparities[barWidth + dy]; }
};

/** Moves the outlines of surfaces to the edges of the image: where disparities have a step, the pixels around vote for
one of its two surfaces. A weighted median @cite Ma2013WM of two surfaces is such a vote.

A step is where disparities of 3 x 3 pixels differ by more than 2 pixels; halfway between the nearest and the farthest
one is the border of the two surfaces. Each pixel of the window around that is on a surface, or less than a pixel beyond
its end, votes for it by max(36 - difference, 0), where difference is the largest one of a channel from that of the
pixel in the middle. The window has 16 columns, of which 7 are on the left of the pixel, all of them inside of the
image, and every third one of 13 rows, the nearest ones of the image. A pixel whose surface has fewer votes than the
other one gets the nearest or the farthest disparity of the 3 x 3.

In bars of up to 8 pixels the nearer surface keeps its pixels: these are fewer than those around, whatever they look
like.
@param image CV_8UC1 or CV_8UC3.
@param disparity CV_16UC1, a disparity map of the same size; USHRT_MAX has no vote, and what is voted
beside it means nothing.
@param voted Receives the map after the vote; another one. The same map if it has less than 16 columns. */
CV_EXPORTS void voteAtEdges(const Mat& image, const Mat& disparity, Mat& voted);

}}} // namespace cv::stereo::hdp

#endif
