/// @file
/// What a program shows: a table on the terminal (and as CSV), pictures, and `result.json` for the gallery.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace course {

/// Digits that carry information: 4 significant ones, no exponent where a reader does not need it.
std::string format_number(double value);

/// One cell of a table: text, or a number written with format_number.
struct Cell {
    std::string text;
    Cell(const char* t) : text(t) {}
    Cell(std::string t) : text(std::move(t)) {}
    Cell(double v) : text(format_number(v)) {}
    Cell(float v) : text(format_number(v)) {}
    Cell(int v) : text(std::to_string(v)) {}
    Cell(std::uint32_t v) : text(std::to_string(v)) {}
    Cell(std::size_t v) : text(std::to_string(v)) {}
};

/// A table with a caption, its column names, and rows of as many cells.
struct Table {
    std::string caption;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    Table(std::string caption_text, std::vector<std::string> column_names)
        : caption(std::move(caption_text)), columns(std::move(column_names)) {}
    /// @throws std::logic_error if the number of cells differs from the number of columns.
    void row(const std::vector<Cell>& cells);
    std::string csv() const;
    void print() const;  ///< aligned, on standard output
};

/// Collects what one run made and writes it to its folder.
class Result {
  public:
    Result(std::string chapter, std::string title, std::string sentence, std::filesystem::path folder);

    std::string device = "CPU";  ///< where the numbers were computed

    /// Names a picture that lies in the folder.
    void picture(const std::string& file, const std::string& caption);
    /// Prints the table and keeps it.
    void table(const Table& table);
    /// One more sentence that belongs to the result; printed and kept.
    void note(const std::string& sentence);
    /// Writes result.json; and the first table as CSV if `csv` is not empty. @throws BadInput if it can't.
    void save(const std::string& command, const std::filesystem::path& csv = {}) const;

    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::string chapter_, title_, sentence_;
    std::filesystem::path folder_;
    std::vector<std::pair<std::string, std::string>> pictures_;
    std::vector<Table> tables_;
    std::vector<std::string> notes_;
};

}  // namespace course
