// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Scores of disparity maps, and the tables made of them in Markdown, CSV and HTML.

#ifndef OPENCV_HDPSTEREO_SAMPLES_TABLES_HPP
#define OPENCV_HDPSTEREO_SAMPLES_TABLES_HPP

#include <sstream>

#include "hdp_datasets.hpp"

namespace hdp_samples {

// ---- Scores

const double NO_SCORE = std::numeric_limits<double>::quiet_NaN();

//! Errors of a map, in percent of the judged pixels but for the average. NO_SCORE where the protocol has none.
struct Score
{
    double error1, error2;    // err>=1 and err>=2 of Middlebury's protocol
    double d1, d1NonOccluded; // of KITTI's
    double average;           // mean absolute error in pixels, of each pixel at most 64
};

//! Share of the mask whose error is above 3 pixels and 5 % of the truth, in percent.
inline double percentD1(const Mat& disparity, const Mat& truth, const Mat& mask)
{
    Mat error;
    cv::absdiff(disparity, truth, error);
    return percent((error > 3) & (error > 0.05 * truth) & mask, mask);
}

inline Score scoreMap(const Mat& disparity, const Pair& pair)
{
    Score score = { NO_SCORE, NO_SCORE, NO_SCORE, NO_SCORE, NO_SCORE };
    if (pair.protocol == Pair::NO_TRUTH)
        return score;
    if (pair.protocol == Pair::MIDDLEBURY)
    {
        score.error1 = percent(wrongPixels(disparity, pair.truth, pair.judged, 1), pair.judged);
        score.error2 = percent(wrongPixels(disparity, pair.truth, pair.judged, 2), pair.judged);
    }
    else
    {
        score.d1 = percentD1(disparity, pair.truth, pair.judged);
        if (!pair.judgedNonOccluded.empty())
            score.d1NonOccluded = percentD1(disparity, pair.truth, pair.judgedNonOccluded);
    }
    Mat error;
    cv::absdiff(disparity, pair.truth, error);
    error.setTo(0, ~pair.judged);
    score.average = cv::sum(cv::min(error, 64))[0] / std::max(cv::countNonZero(pair.judged), 1);
    return score;
}

//! Mean of the numbers that there are; NO_SCORE if there are none.
inline double meanOf(const std::vector<double>& values)
{
    double sum = 0;
    int count = 0;
    for (double value : values)
        if (!std::isnan(value))
        {
            sum += value;
            count++;
        }
    return count > 0 ? sum / count : NO_SCORE;
}

// ---- Tables

struct Cell
{
    String text;
    bool isBest;
};

struct Table
{
    String title, note;
    std::vector<String> header;
    std::vector<std::vector<Cell>> rows; // of the header's size

    void addRow(const String& name) { rows.push_back(std::vector<Cell>(1, Cell{ name, false })); }
    void addText(const String& text) { rows.back().push_back(Cell{ text, false }); }

    //! A number; "-" if it is none.
    void addNumber(double value, const char* printfFormat = "%.2f")
    {
        addText(std::isnan(value) ? String("-") : cv::format(printfFormat, value));
    }

    //! Numbers of the last row; the smallest, as printed, are the best.
    void addNumbers(const std::vector<double>& values, const char* printfFormat = "%.2f")
    {
        const size_t first = rows.back().size();
        double best = std::numeric_limits<double>::max();
        for (double value : values)
        {
            addNumber(value, printfFormat);
            if (!std::isnan(value))
                best = std::min(best, std::stod(rows.back().back().text));
        }
        for (size_t i = 0; i < values.size() && values.size() > 1; i++)
        {
            Cell& cell = rows.back()[first + i];
            cell.isBest = !std::isnan(values[i]) && std::stod(cell.text) == best;
        }
    }
};

inline String toMarkdown(const Table& table)
{
    std::ostringstream out;
    out << "### " << table.title << "\n\n";
    const auto row = [&](const std::vector<String>& cells) {
        for (const String& cell : cells)
            out << "| " << cell << " ";
        out << "|\n";
    };
    row(table.header);
    row(std::vector<String>(table.header.size(), "---"));
    for (const std::vector<Cell>& cells : table.rows)
    {
        std::vector<String> texts;
        for (const Cell& cell : cells)
            texts.push_back(cell.isBest ? "**" + cell.text + "**" : cell.text);
        row(texts);
    }
    if (!table.note.empty())
        out << "\n" << table.note << "\n";
    return out.str();
}

//! A field of a CSV file (RFC 4180)
inline String csvField(const String& text)
{
    if (text.find_first_of(",\"\r\n") == String::npos)
        return text;
    String quoted = "\"";
    for (char c : text)
        quoted += c == '"' ? String("\"\"") : String(1, c);
    return quoted + "\"";
}

//! The table under a line with its title; "-" becomes empty.
inline String toCsv(const Table& table)
{
    std::ostringstream out;
    out << csvField(table.title) << "\n";
    for (size_t i = 0; i < table.header.size(); i++)
        out << (i ? "," : "") << csvField(table.header[i]);
    out << "\n";
    for (const std::vector<Cell>& cells : table.rows)
    {
        for (size_t i = 0; i < cells.size(); i++)
            out << (i ? "," : "") << (cells[i].text == "-" ? String() : csvField(cells[i].text));
        out << "\n";
    }
    return out.str();
}

inline String htmlText(const String& text)
{
    String escaped;
    for (char c : text)
    {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

inline String toHtml(const Table& table)
{
    std::ostringstream out;
    out << "<h3>" << htmlText(table.title) << "</h3>\n<div class=\"scroll\"><table>\n<tr>";
    for (const String& cell : table.header)
        out << "<th>" << htmlText(cell) << "</th>";
    out << "</tr>\n";
    for (const std::vector<Cell>& cells : table.rows)
    {
        out << "<tr>";
        for (const Cell& cell : cells)
            out << (cell.isBest ? "<td class=\"best\">" : "<td>") << htmlText(cell.text) << "</td>";
        out << "</tr>\n";
    }
    out << "</table></div>\n";
    if (!table.note.empty())
        out << "<p>" << htmlText(table.note) << "</p>\n";
    return out.str();
}

} // namespace hdp_samples

#endif
