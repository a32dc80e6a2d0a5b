// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_HELPERS_HPP
#define OPENCV_HDPSTEREO_TEST_HELPERS_HPP

#include "test_precomp.hpp"

#include <functional>

namespace opencv_test {

//! Image of random values 0 .. levels - 1.
inline Mat randomImage(RNG& rng, Size size, int type, int levels = 256)
{
    Mat image(size, type);
    rng.fill(image, RNG::UNIFORM, 0, levels);
    return image;
}

//! Random image of patches of one colour each: many light and many equal edges, as in pictures.
inline Mat patchyImage(RNG& rng, Size size, int type, int patch = 4)
{
    const Mat colors = randomImage(rng, Size(size.width / patch + 1, size.height / patch + 1), type);
    const Mat noise = randomImage(rng, size, type, 12);
    Mat image(size, type);
    const size_t pixel = image.elemSize();
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (size_t c = 0; c < pixel; ++c)
            {
                const int color = colors.ptr(y / patch)[x / patch * pixel + c];
                image.ptr(y)[x * pixel + c] = saturate_cast<uchar>(color + noise.ptr(y)[x * pixel + c]);
            }
    return image;
}

//! Number of elements in which two matrices of one size and type differ.
inline int countDifferent(const Mat& a, const Mat& b)
{
    CV_Assert(a.size() == b.size() && a.type() == b.type());
    Mat different;
    cv::compare(a.reshape(1), b.reshape(1), different, CMP_NE);
    return cv::countNonZero(different);
}

inline void expectIdentical(const Mat& expected, const Mat& actual)
{
    ASSERT_EQ(expected.type(), actual.type());
    ASSERT_EQ(expected.size(), actual.size());
    EXPECT_EQ(0, countDifferent(expected, actual)) << "of " << expected.total() * expected.channels();
}

//! The disparities of a pair.
inline Mat match(StereoMatcher& matcher, InputArray left, InputArray right)
{
    Mat disparity;
    matcher.compute(left, right, disparity);
    return disparity;
}

typedef HDPTreeMatcher::Params Params;

//! Changes some of a matcher's parameters: change(Params&).
template <typename Change> void change(HDPTreeMatcher& matcher, const Change& change)
{
    Params params = matcher.getParams();
    change(params);
    matcher.setParams(params);
}

//! The same as a function, for tables
inline std::function<void(HDPTreeMatcher&)> inParams(const std::function<void(Params&)>& changeParams)
{
    return [changeParams](HDPTreeMatcher& matcher) { change(matcher, changeParams); };
}

//! Expects the action to throw a cv::Exception whose message names the argument.
template <typename Action> void expectRejected(const Action& action, const std::string& argument)
{
    try
    {
        action();
        ADD_FAILURE() << "no exception for a bad " << argument;
    }
    catch (const cv::Exception& e)
    {
        EXPECT_NE(std::string::npos, e.err.find(argument)) << "the message does not name " << argument << ": " << e.err;
    }
    catch (const std::exception& e)
    {
        ADD_FAILURE() << "not a cv::Exception for a bad " << argument << ": " << e.what();
    }
}

//! A picture of OpenCV's samples
inline Mat readSample(const std::string& name, int flags)
{
    const std::string path = cv::samples::findFile(name, false);
    const Mat image = path.empty() ? Mat() : cv::imread(path, flags);
    if (image.empty())
        throw SkipTestException("no " + name +
                                ": set OPENCV_SAMPLES_DATA_PATH to the folder samples/data of OpenCV's source");
    return image;
}

//! Sets the number of threads for a while.
class ScopedThreads
{
public:
    explicit ScopedThreads(int threads) : before_(cv::getNumThreads()) { cv::setNumThreads(threads); }
    ~ScopedThreads() { cv::setNumThreads(before_); }

private:
    int before_;
};

//! A name for a file that is removed in the end
class TemporaryFile
{
public:
    explicit TemporaryFile(const char* suffix) : name(cv::tempfile(suffix)) {}
    ~TemporaryFile() { std::remove(name.c_str()); }
    const String name;
};

//! What write() of an algorithm puts into a file; extension: yml, xml or json.
inline std::string serialized(const Algorithm& algorithm, const std::string& extension = "yml")
{
    FileStorage fs("." + extension, FileStorage::WRITE | FileStorage::MEMORY);
    algorithm.write(fs);
    return fs.releaseAndGetString();
}

//! read() of an algorithm from the text of a file.
inline void deserialize(const std::string& text, Algorithm& algorithm)
{
    FileStorage fs(text, FileStorage::READ | FileStorage::MEMORY);
    algorithm.read(fs.root());
}

} // namespace opencv_test

#endif
