// cudasim_rewrite in.cu out.cpp: the C++ that the simulator compiles in place of a CUDA source file.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "rewriter/rewriter.h"

int main(int count, char** arguments) {
    if (count != 3) {
        std::cerr << "usage: cudasim_rewrite in.cu out.cpp\n";
        return 2;
    }
    std::ifstream in(arguments[1], std::ios::binary);
    if (!in) {
        std::cerr << "cudasim_rewrite: cannot read " << arguments[1] << "\n";
        return 1;
    }
    const std::string source{std::istreambuf_iterator<char>(in), {}};
    const std::filesystem::path copy = arguments[2];
    std::error_code ignored;  // writing says what is wrong
    std::filesystem::create_directories(copy.parent_path(), ignored);
    std::ofstream out(copy, std::ios::binary);
    out << cudasim::rewrite(source, arguments[1]);
    if (!out.flush()) {
        std::cerr << "cudasim_rewrite: cannot write " << arguments[2] << "\n";
        return 1;
    }
    return 0;
}
