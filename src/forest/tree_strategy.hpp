// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_SRC_TREE_STRATEGY_HPP
#define OPENCV_HDPSTEREO_SRC_TREE_STRATEGY_HPP

namespace cv { namespace stereo { namespace hdp {

// The strategies of the library

class MinimumSpanningTree CV_FINAL : public TreeStrategy
{
public:
    bool ordersByWeight() const CV_OVERRIDE { return true; }
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_MinimumSpanningTree"; }
};

//! As in the authors' program, which has the first pass of the segment tree alone, with k = 1200 and without uniting
//! intervals, and a second pass, see linksTrees(), only without prediction. The paper just cites the segment tree.
class SegmentTree CV_FINAL : public TreeStrategy
{
public:
    explicit SegmentTree(double k = 1200);

    bool ordersByWeight() const CV_OVERRIDE { return true; }
    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        return weight <= a.maxWeight + k_ / a.size && weight <= b.maxWeight + k_ / b.size;
    }
    bool unitesIntervals() const CV_OVERRIDE { return false; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_SegmentTree"; }
    void write(FileStorage& fs) const CV_OVERRIDE;
    void read(const FileNode& fn) CV_OVERRIDE;

private:
    double k_;
};

//! The authors' program shuffles by std::random_shuffle, whose order depends on the machine.
class RandomTree CV_FINAL : public TreeStrategy
{
public:
    explicit RandomTree(int seed = 0);

    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE;
    bool mayJoin(int, const TreeState&, const TreeState&) const CV_OVERRIDE { return true; }
    String getDefaultName() const CV_OVERRIDE { return "hdpstereo_RandomTree"; }
    void write(FileStorage& fs) const CV_OVERRIDE;
    void read(const FileNode& fn) CV_OVERRIDE;

private:
    int seed_;
};

//! One of the library's strategies with default parameters, or an empty pointer if none has this name.
Ptr<TreeStrategy> createTreeStrategy(const String& name);

}}} // namespace cv::stereo::hdp

#endif
