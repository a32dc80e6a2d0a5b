// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "video_variants.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "opencv2/imgproc.hpp"

#include "bad_cameras.hpp"
#include "command_line.hpp"

namespace hdp_tools {

using namespace cv;

namespace {

//! The order of the recorded frames, and what is done with a frame of this order
struct Recipe
{
    String name;
    std::function<std::vector<int>(int frames)> order;
    std::function<void(int i, int frames, VariantFrame& frame)> change;
};

std::vector<int> inOrder(int frames)
{
    std::vector<int> order(frames);
    std::iota(order.begin(), order.end(), 0);
    return order;
}

std::function<std::vector<int>(int)> every(int step)
{
    return [=](int frames) {
        std::vector<int> order;
        for (int i = 0; i < frames; i += step)
            order.push_back(i);
        return order;
    };
}

std::vector<int> reversed(int frames)
{
    std::vector<int> order = inOrder(frames);
    std::reverse(order.begin(), order.end());
    return order;
}

std::vector<int> inRandomOrder(int frames)
{
    std::vector<int> order = inOrder(frames);
    RNG rng(5);
    for (int i = frames - 1; i > 0; --i)
        std::swap(order[i], order[rng.uniform(0, i + 1)]);
    return order;
}

std::vector<int> threeTimes(int frames)
{
    std::vector<int> order(3 * frames);
    for (int i = 0; i < 3 * frames; ++i)
        order[i] = i / 3;
    return order;
}

void nothing(int, int, VariantFrame&) {}

std::function<void(int, int, VariantFrame&)> alternating(double gain)
{
    return [=](int i, int, VariantFrame& frame) { frame.gain = i % 2 ? gain : 1; };
}

std::vector<Recipe> allRecipes()
{
    return {
        { "recorded", inOrder, nothing },
        { "every2", every(2), nothing },
        { "every3", every(3), nothing },
        { "every4", every(4), nothing },
        { "reversed", reversed, nothing },
        { "random", inRandomOrder, nothing },
        { "three-times", threeTimes, nothing },
        { "exposure.7", inOrder, alternating(0.7) },
        { "exposure.5", inOrder, alternating(0.5) },
        { "fade", inOrder,
          [](int i, int frames, VariantFrame& frame) { frame.gain = std::abs(1 - 2. * i / std::max(frames - 1, 1)); } },
        { "noise15", inOrder, [](int i, int, VariantFrame& frame) { frame.noise = i % 3 == 2 ? 15 : 0; } },
        { "foreign", inOrder,
          [](int i, int frames, VariantFrame& frame) {
        frame.isReversed = i % 5 == 4;
        if (frame.isReversed)
            frame.index = (i + frames / 2) % frames;
         } },
        { "shake6", inOrder, [](int i, int, VariantFrame& frame) { frame.rows = i % 2 ? 6 : 0; } },
        { "rows3", inOrder, [](int i, int, VariantFrame& frame) { frame.rightRows = i % 2 ? 3 : 0; } },
        };
}

void moveDown(int rows, int border, const Scalar& value, Mat& image)
{
    if (image.empty() || rows == 0)
        return;
    const Mat above = image.rowRange(0, std::max(image.rows - rows, 1)).clone();
    copyMakeBorder(above, image, image.rows - above.rows, 0, 0, 0, border, value);
}

//! Shows a part alone. What it has no match of is not judged.
void cutOut(const Rect& part, Pair& pair)
{
    for (Mat* map : { &pair.left, &pair.right, &pair.truth, &pair.judged, &pair.judgedNonOccluded })
        if (!map->empty())
            *map = (*map)(part).clone();
    for (int y = 0; y < pair.truth.rows; ++y)
        for (int x = 0; x < pair.truth.cols; ++x)
            for (Mat* judged : { &pair.judged, &pair.judgedNonOccluded })
                if (!judged->empty() && pair.truth.at<float>(y, x) > x)
                    judged->at<uchar>(y, x) = 0;
}

} // namespace

std::vector<VideoVariant> selectVariants(const String& list, int frames)
{
    const std::vector<Recipe> recipes = allRecipes();
    std::vector<String> names;
    if (list.empty())
        for (const Recipe& recipe : recipes)
            names.push_back(recipe.name);
    else
        names = splitList("variants", list);
    std::vector<VideoVariant> variants;
    for (const String& name : names)
    {
        const auto recipe =
            std::find_if(recipes.begin(), recipes.end(), [&](const Recipe& r) { return r.name == name; });
        if (recipe == recipes.end())
            fail("--variants knows no variant '" + name + "', see --help");
        VideoVariant variant;
        variant.name = name;
        for (int index : recipe->order(frames))
        {
            variant.frames.push_back(VariantFrame(index));
            recipe->change((int)variant.frames.size() - 1, frames, variant.frames.back());
        }
        variants.push_back(variant);
    }
    return variants;
}

std::vector<VariantFrame> panOver(int index, const Size& size, const Point& step, int frames)
{
    const Point way = step * (frames - 1), distance(std::abs(way.x), std::abs(way.y));
    if (2 * distance.x > size.width || 2 * distance.y > size.height)
        fail(format("--pan moves by more than half of the images, %d x %d pixels", size.width, size.height));
    std::vector<VariantFrame> panned(frames, VariantFrame(index));
    for (int i = 0; i < frames; ++i)
    {
        const Point at = step * i - Point(std::min(way.x, 0), std::min(way.y, 0));
        panned[i].part = Rect(at, Size(size.width - distance.x, size.height - distance.y));
    }
    return panned;
}

void changeFrame(const VariantFrame& frame, RNG& rng, Pair& pair)
{
    if (!frame.part.empty())
        cutOut(frame.part, pair);
    Mat* const maps[] = { &pair.truth, &pair.judged, &pair.judgedNonOccluded };
    if (frame.isReversed)
    {
        flip(pair.left, pair.left, 0);
        flip(pair.right, pair.right, 0);
        for (Mat* map : maps)
            if (!map->empty())
                flip(*map, *map, 0);
    }
    moveDown(frame.rows, BORDER_REPLICATE, Scalar(), pair.left);
    moveDown(frame.rows + frame.rightRows, BORDER_REPLICATE, Scalar(), pair.right);
    moveDown(frame.rows, BORDER_CONSTANT, Scalar::all(NO_DISPARITY), pair.truth);
    moveDown(frame.rows, BORDER_CONSTANT, Scalar(), pair.judged);
    moveDown(frame.rows, BORDER_CONSTANT, Scalar(), pair.judgedNonOccluded);
    for (Mat* image : { &pair.left, &pair.right })
    {
        if (frame.gain != 1)
            image->convertTo(*image, -1, frame.gain);
        *image = addNoise(*image, frame.noise, rng);
    }
}

} // namespace hdp_tools
