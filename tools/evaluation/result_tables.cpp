// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "result_tables.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace hdp_tools {

using cv::format;

typedef double Score::*Figure;
typedef std::vector<const SceneResult*> Selection;

static std::vector<String> setsOf(const std::vector<SceneResult>& results)
{
    std::vector<String> sets;
    for (const SceneResult& result : results)
        if (std::find(sets.begin(), sets.end(), result.scene.set) == sets.end())
            sets.push_back(result.scene.set);
    return sets;
}

//! The results of a set that are to be in its tables: of the pairs that were read, and matched by a method at least.
static Selection resultsOfSet(const std::vector<SceneResult>& results, const String& set, Pair::Protocol protocol)
{
    Selection selected;
    for (const SceneResult& result : results)
    {
        const bool isMatched =
            std::any_of(result.results.begin(), result.results.end(), [](const Result& r) { return r.done; });
        if (result.scene.set == set && result.isRead && result.protocol == protocol && isMatched)
            selected.push_back(&result);
    }
    return selected;
}

//! Those that all methods have matched: only these are in means, so that the means are comparable.
static Selection completeOnes(const Selection& results)
{
    Selection complete;
    std::copy_if(results.begin(), results.end(), std::back_inserter(complete), [](const SceneResult* result) {
        return std::all_of(result->results.begin(), result->results.end(), [](const Result& r) { return r.done; });
    });
    return complete;
}

static double meanFigure(const Selection& results, size_t method, Figure figure)
{
    std::vector<double> values;
    for (const SceneResult* result : results)
        values.push_back(result->results[method].score.*figure);
    return meanOf(values);
}

//! Index of a method; -1 if it is not among them.
static int indexOf(const std::vector<Method>& methods, const String& name)
{
    for (size_t i = 0; i < methods.size(); i++)
        if (methods[i].name == name)
            return int(i);
    return -1;
}

static bool narrowsRange(const Method& method) { return !method.fullRange.empty() || method.isPreset(); }

//! R_l per layer, set and method; the paper's Table 1
static Table searchTable(const std::vector<Method>& methods, const std::vector<SceneResult>& results)
{
    Table table;
    table.title = "Table 1: disparities searched, R_l in percent";
    table.header = { "set and system" };
    size_t layers = 0;
    for (const SceneResult& result : results)
        for (size_t m = 0; m < methods.size(); m++)
            if (narrowsRange(methods[m]))
                layers = std::max(layers, result.results[m].ratios.size());
    for (size_t l = 0; l < layers; l++)
        table.header.push_back(format("layer %d", int(l)));
    for (const String& set : setsOf(results))
        for (size_t m = 0; m < methods.size(); m++)
        {
            if (!narrowsRange(methods[m]))
                continue;
            std::vector<std::vector<double>> ratios(layers);
            for (const SceneResult& result : results)
                for (size_t l = 0; result.scene.set == set && l < result.results[m].ratios.size(); l++)
                    ratios[l].push_back(100 * result.results[m].ratios[l]);
            if (layers == 0 || ratios[0].empty())
                continue;
            table.addRow(set + " " + methods[m].name);
            for (size_t l = 0; l < layers; l++)
                table.addNumber(meanOf(ratios[l]));
        }
    return table;
}

//! A figure per scene and method, and the means
static Table sceneTable(const String& title, const Selection& results, const std::vector<Method>& methods,
                        Figure figure)
{
    Table table;
    table.title = title;
    table.header = { "scene" };
    for (const Method& method : methods)
        table.header.push_back(method.name);
    for (const SceneResult* result : results)
    {
        table.addRow(result->scene.name);
        std::vector<double> values;
        for (const Result& r : result->results)
            values.push_back(r.score.*figure);
        table.addNumbers(values);
    }
    const Selection complete = completeOnes(results);
    table.addRow(format("mean of %d", int(complete.size())));
    std::vector<double> means;
    for (size_t m = 0; m < methods.size(); m++)
        means.push_back(meanFigure(complete, m, figure));
    table.addNumbers(means);
    return table;
}

struct Column
{
    String title;
    Figure figure;
};

//! Means of several figures per method
static Table meanTable(const String& title, const std::vector<Column>& columns, const Selection& results,
                       const std::vector<Method>& methods)
{
    const Selection complete = completeOnes(results);
    Table table;
    table.title = title + format(", means of %d pairs", int(complete.size()));
    table.header = { "system" };
    for (const Column& column : columns)
        table.header.push_back(column.title);
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        for (const Column& column : columns)
            table.addNumber(meanFigure(complete, m, column.figure));
    }
    return table;
}

//! What becomes of occluded pixels, and what the confidence is worth
static Table reliabilityTable(const String& set, Pair::Protocol protocol, const Selection& results,
                              const std::vector<Method>& methods)
{
    const Selection complete = completeOnes(results);
    Table table;
    table.title = format("Occlusions and confidence of %s, means of %d pairs", set.c_str(), int(complete.size()));
    table.header = { "system", "occluded pixels, " + mainScoreName(protocol), "area of the sparsification curve",
                     "least area", "ratio of the areas" };
    for (size_t m = 0; m < methods.size(); m++)
    {
        const double area = meanFigure(complete, m, &Score::sparsification);
        const double least = meanFigure(complete, m, &Score::leastSparsification);
        table.addRow(methods[m].name);
        table.addNumber(meanFigure(complete, m, &Score::occluded));
        table.addNumber(area);
        table.addNumber(least);
        table.addNumber(least > 0 ? area / least : NO_SCORE);
    }
    return table;
}

//! Means of err>=1 and err>=2 per set; the paper's Table 3
static Table averageTable(const std::vector<String>& sets, const std::vector<Method>& methods,
                          const std::vector<SceneResult>& results)
{
    Table table;
    table.title = "Table 3: average errors, percent of the non-occluded pixels";
    table.header = { "system" };
    std::vector<Selection> ofSets;
    for (const String& set : sets)
    {
        ofSets.push_back(completeOnes(resultsOfSet(results, set, Pair::MIDDLEBURY)));
        const String count = format(" (%d scenes)", int(ofSets.back().size()));
        table.header.push_back(set + count + ": err>=1");
        table.header.push_back(set + count + ": err>=2");
    }
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        for (const Selection& ofSet : ofSets)
        {
            table.addNumber(meanFigure(ofSet, m, &Score::error1));
            table.addNumber(meanFigure(ofSet, m, &Score::error2));
        }
    }
    return table;
}

//! The times of a method beside those of another one, such as the same over the full range
static std::vector<RuntimePair> runtimePairs(const Selection& results, size_t method, size_t other)
{
    std::vector<RuntimePair> pairs;
    for (const SceneResult* result : results)
        pairs.push_back({ result->scene.name, result->results[other].seconds, result->results[method].seconds });
    return pairs;
}

//! Mean, least and largest of how many times faster a method is; "-" if there is nothing to compare with.
static void addSpeedUps(Table& table, const Selection& results, size_t method, int other)
{
    std::vector<double> speedUps;
    if (other >= 0 && size_t(other) != method)
        for (const RuntimePair& p : runtimePairs(results, method, size_t(other)))
            speedUps.push_back(p.other / p.method);
    const bool any = !speedUps.empty();
    table.addNumber(meanOf(speedUps));
    table.addNumber(any ? *std::min_element(speedUps.begin(), speedUps.end()) : NO_SCORE);
    table.addNumber(any ? *std::max_element(speedUps.begin(), speedUps.end()) : NO_SCORE);
}

//! Mean times, and how many times faster each method is than StereoSGBM and than over the full range, which is the
//! paper's runtime figure
static Table runtimeTable(const String& set, const std::vector<Method>& methods, const Selection& results, int jobs)
{
    Table table;
    table.title = format("Runtime: means over %d pairs of %s", int(results.size()), set.c_str());
    table.header = { "system", "seconds", "times faster than " + String(REFERENCE_METHOD) + ": mean",
                     "least",  "most",    "times faster than over the full range: mean",
                     "least",  "most" };
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        std::vector<double> seconds;
        for (const SceneResult* result : results)
            seconds.push_back(result->results[m].seconds);
        table.addNumber(meanOf(seconds), "%.3f");
        addSpeedUps(table, results, m, indexOf(methods, REFERENCE_METHOD));
        addSpeedUps(table, results, m, indexOf(methods, methods[m].fullRange));
    }
    if (jobs > 1)
        table.note = format("%d pairs were matched at a time.", jobs);
    return table;
}

std::vector<Table> makeTables(const std::vector<Method>& methods, const std::vector<SceneResult>& results, int jobs)
{
    const std::vector<String> sets = setsOf(results);
    std::vector<Table> tables(1, searchTable(methods, results));
    std::vector<String> middleburySets;
    for (const String& set : sets)
    {
        const Selection ofSet = resultsOfSet(results, set, Pair::MIDDLEBURY);
        if (ofSet.empty())
            continue;
        middleburySets.push_back(set);
        tables.push_back(sceneTable("Table 2: err>=2 of " + set + ", percent of the non-occluded pixels", ofSet,
                                    methods, &Score::error2));
    }
    if (!middleburySets.empty())
        tables.push_back(averageTable(middleburySets, methods, results));
    for (const String& set : sets)
    {
        const Selection kitti = resultsOfSet(results, set, Pair::KITTI);
        if (!kitti.empty())
        {
            tables.push_back(
                sceneTable("KITTI: D1 of " + set + ", percent of all known pixels", kitti, methods, &Score::d1));
            tables.push_back(meanTable("KITTI: " + set,
                                       { { "D1, percent of all known pixels", &Score::d1 },
                                         { "D1, percent of the non-occluded", &Score::d1NonOccluded },
                                         { "average error, pixels", &Score::average } },
                                       kitti, methods));
        }
        const Selection bad = resultsOfSet(results, set, Pair::BAD);
        if (!bad.empty())
        {
            tables.push_back(
                sceneTable("bad 2.0 of " + set + ", percent of the non-occluded pixels", bad, methods, &Score::bad2));
            tables.push_back(meanTable("Errors of " + set + ", percent of the non-occluded pixels",
                                       { { "bad 0.5", &Score::badHalf },
                                         { "bad 1.0", &Score::bad1 },
                                         { "bad 2.0", &Score::bad2 },
                                         { "bad 4.0", &Score::bad4 },
                                         { "average error, pixels", &Score::average } },
                                       bad, methods));
        }
    }
    for (const String& set : sets)
        for (Pair::Protocol protocol : { Pair::MIDDLEBURY, Pair::KITTI, Pair::BAD })
        {
            const Selection ofSet = resultsOfSet(results, set, protocol);
            if (!ofSet.empty())
                tables.push_back(reliabilityTable(set, protocol, ofSet, methods));
        }
    for (const String& set : sets)
        for (Pair::Protocol protocol : { Pair::MIDDLEBURY, Pair::KITTI, Pair::BAD, Pair::NO_TRUTH })
        {
            const Selection complete = completeOnes(resultsOfSet(results, set, protocol));
            if (!complete.empty())
                tables.push_back(runtimeTable(set, methods, complete, jobs));
        }
    tables.erase(std::remove_if(tables.begin(), tables.end(), [](const Table& table) { return table.rows.empty(); }),
                 tables.end());
    return tables;
}

Table everyPairTable(const std::vector<Method>& methods, const std::vector<SceneResult>& results)
{
    const std::vector<Column> columns = { { "err>=1 %", &Score::error1 },
                                          { "err>=2 %", &Score::error2 },
                                          { "bad 0.5 %", &Score::badHalf },
                                          { "bad 1 %", &Score::bad1 },
                                          { "bad 2 %", &Score::bad2 },
                                          { "bad 4 %", &Score::bad4 },
                                          { "D1 %", &Score::d1 },
                                          { "D1 noc %", &Score::d1NonOccluded },
                                          { "average px", &Score::average },
                                          { "occluded %", &Score::occluded },
                                          { "sparsification %", &Score::sparsification },
                                          { "least sparsification %", &Score::leastSparsification } };
    Table table;
    table.title = "Every pair";
    table.header = { "set", "scene", "method" };
    for (const Column& column : columns)
        table.header.push_back(column.title);
    table.header.push_back("runtime seconds");
    table.header.push_back("R_l in percent, by layer");
    for (const SceneResult& result : results)
        for (size_t m = 0; m < methods.size(); m++)
        {
            const Result& r = result.results[m];
            if (!r.done)
                continue;
            table.addRow(result.scene.set);
            table.addText(result.scene.name);
            table.addText(methods[m].name);
            for (const Column& column : columns)
                table.addNumber(r.score.*column.figure, "%.4f");
            table.addNumber(r.seconds, "%.4f");
            String ratios;
            for (double ratio : r.ratios)
                ratios += (ratios.empty() ? "" : " ") + format("%.3f", 100 * ratio);
            table.addText(ratios);
        }
    return table;
}

String reportPage(const std::vector<Table>& tables, const std::vector<Method>& methods,
                  const std::vector<SceneResult>& results, const String& summary)
{
    std::ostringstream body;
    body << "<p>" << htmlText(summary) << "</p>\n";
    for (const SceneResult& result : results)
        for (const String& problem : result.problems)
            body << "<p class=\"problem\">" << htmlText(problem) << "</p>\n";
    body << "<p>Pairs:";
    for (size_t i = 0; i < results.size(); i++)
        if (results[i].isRead)
            body << " <a href=\"#pair" << i << "\">" << htmlText(results[i].scene.title()) << "</a>";
    body << "</p>\n";
    for (const Table& table : tables)
        body << toHtml(table);
    body << "<div class=\"scroll\">\n";
    for (const String& set : setsOf(results))
        for (size_t m = 0; m < methods.size(); m++)
        {
            const int fullRange = indexOf(methods, methods[m].fullRange);
            if (fullRange < 0)
                continue;
            for (Pair::Protocol protocol : { Pair::MIDDLEBURY, Pair::KITTI, Pair::BAD })
                body << runtimeChart(
                    "Runtime, " + set + ": " + methods[m].fullRange + " (pale), " + methods[m].name +
                        " (dark), speed-up (red)",
                    runtimePairs(completeOnes(resultsOfSet(results, set, protocol)), m, size_t(fullRange)));
        }
    body << "</div>\n<p>Maps: blue is far, orange near. Red pixels are wrong: by 2 pixels and more (Middlebury 2001 to "
            "2006), by more than 2 pixels (Middlebury 2014, MiddEval3, ETH3D), by more than 3 pixels and 5 % (KITTI). "
            "Black pixels have no disparity, or are not judged (but in KITTI): they are occluded, or their truth is "
            "unknown. P(D_l | D_{l+1}): each row is a disparity of the layer above, from the top, each column a "
            "disparity of the layer; the largest element of a row is the brightest.</p>\n";
    for (size_t i = 0; i < results.size(); i++)
    {
        const SceneResult& result = results[i];
        if (!result.isRead)
            continue;
        body << "<h2 id=\"pair" << i << "\">" << htmlText(result.scene.title())
             << format(" (%d x %d)", result.size.width, result.size.height) << "</h2>\n<div class=\"figures\">\n"
             << result.maps << "</div>\n";
        if (!result.predictions.empty())
            body << "<h3>Prediction</h3>\n" << result.predictions;
    }
    return htmlPage("Hierarchical disparity prediction: evaluation", body.str());
}

} // namespace hdp_tools
