/// @file
/// The little of C++'s grammar that the rewriter needs.
#pragma once
#include <cstddef>
#include <string>

namespace cudasim {

/// Length of the comment, string, raw string or character literal that begins at `at`; 0 if none does.
/// Nothing in there may be rewritten.
std::size_t literal_length(const std::string& source, std::size_t at);

/// Letter, digit or underscore.
bool is_word(char c);

/// Length of the word (identifier, keyword, number) that begins at `at`; 0 if none does.
std::size_t word_length(const std::string& source, std::size_t at);

/// Position of the first `wanted` at or after `at` that is not inside brackets or literals; npos if there is
/// none.
std::size_t find_outside_brackets(const std::string& source, std::size_t at, const std::string& wanted);

/// The same text with each literal and comment replaced by blanks; newlines stay.
std::string without_literals(const std::string& source);

}  // namespace cudasim
