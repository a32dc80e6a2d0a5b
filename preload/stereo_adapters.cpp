// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "stereo_adapters.hpp"

namespace {

using namespace cv;
using cv::stereo::HDPTreeMatcher;

//! The setter and the getter of a parameter
#define HDP_KEPT(type, Name)                                                                                           \
    void set##Name(type value) CV_OVERRIDE { this->kept_->set##Name(value); }                                          \
    type get##Name() const CV_OVERRIDE { return this->kept_->get##Name(); }

//! What the adapters have in common. Interface: cv::StereoSGBM or cv::StereoBM.
template <class Interface> class Adapter : public Interface
{
public:
    Adapter(const Ptr<Interface>& kept, int preset) : kept_(kept), matcher_(HDPTreeMatcher::create(0, 16, preset)) {}

    // cv::StereoMatcher
    HDP_KEPT(int, MinDisparity)
    HDP_KEPT(int, NumDisparities)
    HDP_KEPT(int, BlockSize)
    HDP_KEPT(int, SpeckleWindowSize)
    HDP_KEPT(int, SpeckleRange)
    HDP_KEPT(int, Disp12MaxDiff)

    // cv::Algorithm
    void clear() CV_OVERRIDE { kept_->clear(); }
    void write(FileStorage& fs) const CV_OVERRIDE { kept_->write(fs); }
    void read(const FileNode& fn) CV_OVERRIDE { kept_->read(fn); }
    bool empty() const CV_OVERRIDE { return kept_->empty(); }
    void save(const String& filename) const CV_OVERRIDE { kept_->save(filename); }
    String getDefaultName() const CV_OVERRIDE { return kept_->getDefaultName(); }

protected:
    //! Sets what has the same meaning in both matchers.
    void configure()
    {
        matcher_->setMinDisparity(kept_->getMinDisparity());
        if (kept_->getNumDisparities() <= 0) // which it does not take, either
            CV_Error(Error::StsOutOfRange, "numDisparities must be > 0");
        matcher_->setNumDisparities(kept_->getNumDisparities());
        matcher_->setSpeckleWindowSize(kept_->getSpeckleWindowSize());
    }

    const Ptr<Interface> kept_;
    const Ptr<HDPTreeMatcher> matcher_;
};

class SGBMAdapter CV_FINAL : public Adapter<StereoSGBM>
{
public:
    SGBMAdapter(const Ptr<StereoSGBM>& kept, int preset) : Adapter<StereoSGBM>(kept, preset) {}

    void compute(InputArray left, InputArray right, OutputArray disparity) CV_OVERRIDE
    {
        configure();
        matcher_->setDisp12MaxDiff(kept_->getDisp12MaxDiff());
        matcher_->setSpeckleRange(std::max(kept_->getSpeckleRange(), 0));
        matcher_->compute(left, right, disparity);
    }

    HDP_KEPT(int, PreFilterCap)
    HDP_KEPT(int, UniquenessRatio)
    HDP_KEPT(int, P1)
    HDP_KEPT(int, P2)
    HDP_KEPT(int, Mode)
};

class BMAdapter CV_FINAL : public Adapter<StereoBM>
{
public:
    BMAdapter(const Ptr<StereoBM>& kept, int preset) : Adapter<StereoBM>(kept, preset) {}

    void compute(InputArray left, InputArray right, OutputArray disparityArray) CV_OVERRIDE
    {
        configure();
        // Other than in cv::StereoSGBM, a difference of 0 is a limit, too, and a range is in 1/16 pixel, or negative
        // for no filter. HDPTreeMatcher has whole pixels.
        const int maxDiff = kept_->getDisp12MaxDiff(), range = kept_->getSpeckleRange();
        matcher_->setDisp12MaxDiff(maxDiff == 0 ? 1 : maxDiff);
        matcher_->setSpeckleRange(range <= 0 ? 0 : (range - 1) / StereoMatcher::DISP_SCALE + 1);
        if (range < 0)
            matcher_->setSpeckleWindowSize(0);
        matcher_->compute(left, right, disparityArray);

        const Rect roi1 = kept_->getROI1(), roi2 = kept_->getROI2();
        if (roi1.empty() && roi2.empty())
            return;
        Mat disparity = disparityArray.getMat();
        const Rect whole(Point(), disparity.size());
        const int minDisparity = kept_->getMinDisparity();
        const Rect valid =
            whole & getValidDisparityROI(roi1.empty() ? whole : roi1, roi2.empty() ? whole : roi2, minDisparity,
                                         kept_->getNumDisparities(), kept_->getBlockSize());
        Mat outside(disparity.size(), CV_8U, Scalar(255));
        outside(valid).setTo(0);
        disparity.setTo((minDisparity - 1) * (disparity.depth() == CV_16S ? (int)StereoMatcher::DISP_SCALE : 1),
                        outside);
    }

    HDP_KEPT(int, PreFilterType)
    HDP_KEPT(int, PreFilterSize)
    HDP_KEPT(int, PreFilterCap)
    HDP_KEPT(int, TextureThreshold)
    HDP_KEPT(int, UniquenessRatio)
    HDP_KEPT(int, SmallerBlockSize)
    HDP_KEPT(Rect, ROI1)
    HDP_KEPT(Rect, ROI2)
};

} // namespace

void hdpstereoAdaptSGBM(Ptr<StereoSGBM>& matcher, int preset) { matcher = makePtr<SGBMAdapter>(matcher, preset); }

void hdpstereoAdaptBM(Ptr<StereoBM>& matcher, int preset) { matcher = makePtr<BMAdapter>(matcher, preset); }
