#include "common/result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/files.h"

namespace course {

std::string format_number(double value) {
    char text[32];
    const bool long_number = std::abs(value) >= 9999.5 && std::abs(value) < 1e9;  // %g would write 2.526e+04
    std::snprintf(text, sizeof text, long_number ? "%.0f" : "%.4g", value);
    return text;
}

void Table::row(const std::vector<Cell>& cells) {
    if (cells.size() != columns.size()) throw std::logic_error("table row with the wrong number of cells");
    std::vector<std::string> texts;
    for (const Cell& cell : cells) texts.push_back(cell.text);
    rows.push_back(std::move(texts));
}

std::string Table::csv() const {
    std::string out;
    const auto line = [&](const std::vector<std::string>& fields) {
        for (std::size_t k = 0; k < fields.size(); ++k) {
            const bool quote = fields[k].find_first_of(",\"") != std::string::npos;
            std::string field = fields[k];
            for (std::size_t at = 0; quote && (at = field.find('"', at)) != std::string::npos; at += 2)
                field.insert(at, 1, '"');
            out += (k ? "," : "") + (quote ? '"' + field + '"' : field);
        }
        out += '\n';
    };
    line(columns);
    for (const auto& fields : rows) line(fields);
    return out;
}

void Table::print() const {
    std::vector<std::size_t> width;
    for (const std::string& name : columns) width.push_back(name.size());
    for (const auto& fields : rows)
        for (std::size_t k = 0; k < fields.size(); ++k) width[k] = std::max(width[k], fields[k].size());
    const auto line = [&](const std::vector<std::string>& fields) {
        for (std::size_t k = 0; k < fields.size(); ++k)
            std::printf(k == 0 ? "  %-*s" : "  %*s", int(width[k]), fields[k].c_str());
        std::printf("\n");
    };
    std::printf("\n%s\n", caption.c_str());
    line(columns);
    for (const auto& fields : rows) line(fields);
}

Result::Result(std::string chapter, std::string title, std::string sentence, std::filesystem::path folder)
    : chapter_(std::move(chapter)),
      title_(std::move(title)),
      sentence_(std::move(sentence)),
      folder_(std::move(folder)) {}

void Result::picture(const std::string& file, const std::string& caption) {
    pictures_.emplace_back(file, caption);
}

void Result::table(const Table& table) {
    table.print();
    tables_.push_back(table);
}

void Result::note(const std::string& sentence) {
    std::printf("%s\n", sentence.c_str());
    notes_.push_back(sentence);
}

void Result::save(const std::string& command, const std::filesystem::path& csv) const {
    nlohmann::ordered_json json;
    json["chapter"] = chapter_;
    json["title"] = title_;
    json["sentence"] = sentence_;
    json["device"] = device;
    json["command"] = command;
    json["pictures"] = nlohmann::ordered_json::array();
    for (const auto& [file, caption] : pictures_)
        json["pictures"].push_back({{"file", file}, {"caption", caption}});
    json["tables"] = nlohmann::ordered_json::array();
    for (const Table& table : tables_)
        json["tables"].push_back(
            {{"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}});
    json["notes"] = notes_;
    write_file(folder_ / "result.json",
               json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!csv.empty() && !tables_.empty()) write_file(csv, tables_.front().csv());
}

}  // namespace course
