// SPDX-License-Identifier: Apache-2.0
// Build-time program: turns files into a C++ file of byte arrays. embed_files OUT.cpp NAME=PATH...
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

/// Adds one array; false if the file cannot be read.
bool appendArray(std::string& code, int number, const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) return false;
    const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    code += "const unsigned char kFile" + std::to_string(number) + "[] = {";
    for (size_t i = 0; i < bytes.size(); ++i) {
        if (i % 32 == 0) code += "\n    ";
        code += std::to_string(unsigned(static_cast<unsigned char>(bytes[i])));
        code += ',';
    }
    code += "\n};\n";
    return !bytes.empty();
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3) {
        std::fprintf(stderr, "usage: embed_files OUT.cpp NAME=PATH...\n");
        return 1;
    }
    std::string code = "// Made by embed_files; do not edit.\n#include \"city/pack/embedded_files.h\"\n\nnamespace "
                       "helio {\nnamespace {\n\n";
    std::string table;
    for (int i = 2; i < argc; ++i) {
        const std::string argument = argv[i];
        const size_t equals = argument.find('=');
        const std::string name = argument.substr(0, equals),
                          path = equals == std::string::npos ? "" : argument.substr(equals + 1);
        if (!appendArray(code, i, path)) {
            std::fprintf(stderr, "embed_files: cannot read '%s' or it is empty\n", path.c_str());
            return 1;
        }
        table += "    {\"" + name + "\", std::as_bytes(std::span(kFile" + std::to_string(i) + "))},\n";
    }
    code += "\nconst EmbeddedFile kFiles[] = {\n" + table + "};\n\n} // namespace\n\n";
    code += "std::span<const EmbeddedFile> embeddedFiles() { return kFiles; }\n\n} // namespace helio\n";
    std::ofstream out(argv[1], std::ios::binary);
    out << code;
    out.close();
    if (!out) {
        std::fprintf(stderr, "embed_files: cannot write '%s'\n", argv[1]);
        return 1;
    }
    return 0;
}
