// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_EDGE_VOTE_ROWS_HPP
#define OPENCV_HDPSTEREO_EDGE_VOTE_ROWS_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo { namespace hdp {

//! What is around a row of voteAtEdges()
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
    // The window's rows
    const uchar* colour[maxChannels][rows];
    const ushort* disparity[rows];
    int channels;                      // of the colours: 1 or maxChannels
    const ushort *above, *below;       // disparities of the rows beside the one in the middle
    const ushort *farAbove, *farBelow; // the same, barWidth rows away
    int width;
};

//! How pixels vote
struct VoteRule
{
    ushort likeness;       // the difference of colours from which on votes count nothing
    ushort minStep, reach; // of disparities: what is a step, and how far beyond its ends the surfaces go
    ushort rowNearness[VoteRows::rows];
    const ushort* columnNearness; // by the distance, which may be negative
};

}}} // namespace cv::stereo::hdp

#endif
