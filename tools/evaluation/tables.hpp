// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Tables in Markdown, CSV and HTML.

#ifndef OPENCV_HDPSTEREO_TOOLS_TABLES_HPP
#define OPENCV_HDPSTEREO_TOOLS_TABLES_HPP

#include <vector>

#include "opencv2/core.hpp"

namespace hdp_tools {

using cv::String;

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

    void addRow(const String& name);
    void addText(const String& text);

    //! A number; "-" if it is none.
    void addNumber(double value, const char* printfFormat = "%.2f");

    //! Numbers of the last row; the smallest, as printed, are the best.
    void addNumbers(const std::vector<double>& values, const char* printfFormat = "%.2f");
};

String toMarkdown(const Table& table);

//! The table under a line with its title (RFC 4180); "-" becomes empty.
String toCsv(const Table& table);

String toHtml(const Table& table);

//! The text with what HTML reserves escaped
String htmlText(const String& text);

} // namespace hdp_tools

#endif
