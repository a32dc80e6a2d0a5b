// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace hdp_tools {

void Table::addRow(const String& name) { rows.push_back(std::vector<Cell>(1, Cell{ name, false })); }
void Table::addText(const String& text) { rows.back().push_back(Cell{ text, false }); }

void Table::addNumber(double value, const char* printfFormat)
{
    addText(std::isnan(value) ? String("-") : cv::format(printfFormat, value));
}

void Table::addNumbers(const std::vector<double>& values, const char* printfFormat)
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

//! A cell ends at a bar.
static String markdownCell(const String& text)
{
    String escaped;
    for (char c : text)
        escaped += c == '|' ? String("\\|") : String(1, c);
    return escaped;
}

String toMarkdown(const Table& table)
{
    std::ostringstream out;
    out << "### " << table.title << "\n\n";
    const auto row = [&](const std::vector<String>& cells) {
        for (const String& cell : cells)
            out << "| " << markdownCell(cell) << " ";
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
static String csvField(const String& text)
{
    if (text.find_first_of(",\"\r\n") == String::npos)
        return text;
    String quoted = "\"";
    for (char c : text)
        quoted += c == '"' ? String("\"\"") : String(1, c);
    return quoted + "\"";
}

String toCsv(const Table& table)
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

String htmlText(const String& text)
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

String toHtml(const Table& table)
{
    std::ostringstream out;
    const bool isWide = table.header.size() > 8; // its header stands upright, so that it fits on the page
    out << "<h3>" << htmlText(table.title) << "</h3>\n<div class=\"scroll\"><table" << (isWide ? " class=\"wide\"" : "")
        << ">\n<tr>";
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

} // namespace hdp_tools
