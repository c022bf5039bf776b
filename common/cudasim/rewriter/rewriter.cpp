#include "rewriter/rewriter.h"

#include <algorithm>
#include <filesystem>

#include "rewriter/lexer.h"
#include "rewriter/shared_declaration.h"

namespace cudasim {
namespace {

constexpr std::size_t kNone = std::string::npos;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::string newlines_of(const std::string& text) {
    return std::string(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
}

class Rewriter {
  public:
    Rewriter(const std::string& source, const std::string& path) : source_(source), path_(path) {}

    std::string run() {
        out_ = "#line 1 \"" + path_ + "\"\n";
        while (at_ < source_.size()) step();
        return out_;
    }

  private:
    void step() {
        const bool line_begins = out_.back() == '\n' && !(at_ > 1 && source_[at_ - 2] == '\\');
        if (line_begins) in_directive_ = false;
        if (line_begins && directive()) return;
        const std::size_t literal = literal_length(source_, at_);
        const std::size_t word = literal ? 0 : word_length(source_, at_);
        if (source_.compare(at_, 3, "<<<") == 0 && last_word() != "operator")
            launch();
        else if (word && !in_directive_ && source_.compare(at_, word, "__shared__") == 0)
            shared_memory(at_ + word);
        else
            copy(std::max<std::size_t>({literal, word, 1}));
    }

    void copy(std::size_t length) {
        out_.append(source_, at_, length);
        at_ += length;
    }

    /// #include "beside.h": the copy lies in another folder, so the file's own neighbours get their full
    /// path. CUDA headers (.cuh) lie beside the copy, rewritten.
    bool directive() {
        std::size_t at = source_.find_first_not_of(" \t", at_);
        if (at == kNone || source_[at] != '#') return false;
        in_directive_ = true;
        at = source_.find_first_not_of(" \t", at + 1);
        if (at == kNone || source_.compare(at, 7, "include") != 0) return false;
        const std::size_t line_end = std::min(source_.find('\n', at), source_.size());
        const std::size_t open = source_.find('"', at), close = source_.find('"', open + 1);
        if (open == kNone || close == kNone || close > line_end) return false;
        const std::string name = source_.substr(open + 1, close - open - 1);
        const auto neighbour = std::filesystem::path(path_).parent_path() / name;
        const std::string extension = neighbour.extension().string();
        if (extension == ".cuh" || extension == ".cu" || !std::filesystem::exists(neighbour)) return false;
        copy(open + 1 - at_);
        out_ += neighbour.string();
        at_ = close;
        return true;
    }

    /// kernel<<<grid, block>>>  ->  CUDASIM_LAUNCH(kernel)(grid, block)
    void launch() {
        const std::size_t name_end = out_.find_last_not_of(" \t\r\n") + 1;
        const std::size_t name_begin = kernel_begin(name_end);
        const std::size_t close = find_outside_brackets(source_, at_ + 3, ">>>");
        if (name_begin == name_end) return reject("there is no kernel's name before <<<", 3);
        if (close == kNone) return reject("<<< without >>>", 3);
        const std::string configuration = source_.substr(at_ + 3, close - at_ - 3);
        if (std::all_of(configuration.begin(), configuration.end(), is_blank))
            return reject("a launch needs its grid and block: kernel<<<grid, block>>>(arguments)", 3);
        const std::size_t arguments = source_.find_first_not_of(" \t\r\n", close + 3);
        if (arguments == kNone || source_[arguments] != '(')
            return reject("a launch needs its arguments: kernel<<<grid, block>>>(arguments)", 3);
        const std::string name = out_.substr(name_begin, name_end - name_begin), gap = out_.substr(name_end);
        out_.resize(name_begin);
        out_ += "CUDASIM_LAUNCH(" + name + ")" + gap + "(" + configuration + ")";
        at_ = close + 3;
    }

    /// Where the kernel's name begins that ends at `end` of the output: name, ns::name, name<arguments>, (a ?
    /// b : c).
    std::size_t kernel_begin(std::size_t end) const {
        std::size_t begin = end;
        if (begin > 0 && out_[begin - 1] == '>') begin = opening(begin, '<', '>');
        while (begin > 0 && is_blank(out_[begin - 1])) --begin;
        if (begin > 0 && out_[begin - 1] == ')') return opening(begin, '(', ')');
        if (begin > 0 && out_[begin - 1] == ']') begin = opening(begin, '[', ']');
        while (begin > 0 && (is_word(out_[begin - 1]) || out_[begin - 1] == ':')) --begin;
        return begin;
    }

    /// Position of the bracket that the one just before `end` closes.
    std::size_t opening(std::size_t end, char open, char close) const {
        int depth = 0, round = 0;
        for (std::size_t at = end; at-- > 0;) {
            const char c = out_[at];
            if (open == '<' && (c == '(' || c == ')')) round += c == ')' ? 1 : -1;  // f<(a > b)>
            if (round == 0 && c == close) ++depth;
            if (round == 0 && c == open && --depth == 0) return at;
        }
        return end;
    }

    void shared_memory(std::size_t after_word) {
        const std::size_t semicolon = find_outside_brackets(source_, after_word, ";");
        std::string qualifiers;
        bool dynamic = false;
        for (std::string word = last_word(); word == "extern" || word == "static" || word == "volatile";
             word = last_word()) {
            dynamic |= word == "extern";
            if (word == "volatile") qualifiers = "volatile ";
            const std::size_t begin = out_.rfind(word);
            out_ = out_.substr(0, begin) + newlines_of(out_.substr(begin));
        }
        const std::size_t length = 10;  // of the word __shared__
        if (semicolon == kNone) return reject("__shared__ without a semicolon after it", length);
        const std::string declaration = qualifiers + source_.substr(after_word, semicolon - after_word);
        if (dynamic) {
            const auto array = dynamic_array(declaration);
            if (!array)
                return reject("extern __shared__ needs the form: extern __shared__ type name[];", length);
            out_ += array->type + "* const " + array->name + " = static_cast<" + array->type +
                    "*>(::cudasim::dynamic_shared());" + newlines_of(declaration);
        } else {
            const auto names = declared_names(declaration);
            if (!names) return reject("__shared__ needs the form: __shared__ type name[size];", length);
            const std::string& first = names->front();
            out_ +=
                "CUDASIM_SHARED_BEGIN(" + first + ")" + declaration + "; CUDASIM_SHARED_END(" + first + ")";
            for (const std::string& name : *names)
                out_ += " [[maybe_unused]] auto& " + name + " = cudasim_memory_" + first + "." + name + ";";
        }
        at_ = semicolon + 1;
    }

    /// The word that the output ends with, blanks behind it aside.
    std::string last_word() const {
        const std::size_t end = out_.find_last_not_of(" \t\r\n") + 1;
        std::size_t begin = end;
        while (begin > 0 && is_word(out_[begin - 1])) --begin;
        return out_.substr(begin, end - begin);
    }

    /// A compile error at this line, in place of the next `skip` characters.
    void reject(const std::string& message, std::size_t skip) {
        const auto at = source_.begin() + static_cast<std::ptrdiff_t>(at_);
        const std::string line = "#line " + std::to_string(std::count(source_.begin(), at, '\n') + 1) + "\n";
        out_ += "\n" + line + "#error \"" + message + "\"\n" + line;
        at_ += skip;
    }

    const std::string& source_;
    const std::string& path_;
    std::string out_;
    std::size_t at_ = 0;  ///< what of the source comes next
    bool in_directive_ = false;
};

}  // namespace

std::string rewrite(const std::string& source, const std::string& path) {
    return Rewriter(source, path).run();
}

}  // namespace cudasim
