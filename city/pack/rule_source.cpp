// SPDX-License-Identifier: Apache-2.0
#include "city/pack/rule_source.h"

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/grammar/limits.h"
#include "city/grammar/program.h"
#include "city/pack/embedded_files.h"

namespace helio {
namespace {

const EmbeddedFile* shippedFile(const std::string& name)
{
    for (const EmbeddedFile& file : embeddedFiles())
        if (file.name == name) return &file;
    return nullptr;
}

Result<std::string> shippedText(const std::string& name)
{
    const EmbeddedFile* file = shippedFile(name);
    if (file == nullptr) return Error{concat(name, ": no such rule file is shipped")};
    return std::string(reinterpret_cast<const char*>(file->bytes.data()), file->bytes.size());
}

/// A device or a pipe has no end that could be waited for, and no rule file is as large as that of the limit.
Result<std::string> fileText(const std::string& path)
{
    std::error_code failure;
    if (!std::filesystem::exists(path, failure) || std::filesystem::is_directory(path, failure))
        return readTextFile(path);
    if (!std::filesystem::is_regular_file(path, failure))
        return Error{concat(path, ": is no regular file; copy the rules into one")};
    const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
    if (bytes > cga::kMaxSourceBytes)
        return Error{concat(path, ": ", bytes, " bytes; a rule file has at most ", cga::kMaxSourceBytes)};
    return readTextFile(path);
}

} // namespace

Result<RuleSource> readRules(const std::filesystem::path& path, const std::string& style)
{
    std::error_code ignored;
    const bool shipped = !std::filesystem::exists(path, ignored) && shippedFile(path.string()) != nullptr;
    RuleOptions options;
    options.style = style;
    options.readImport = shipped ? shippedText : fileText;
    const Result<std::string> text = options.readImport(path.string());
    if (!text) return text.error();
    Result<RuleSet> rules = parseRules(*text, path.string(), options);
    if (!rules) return rules.error();
    u64 hash = hashText(style);
    for (const cga::SourceFile& file : rules->files()) hash = mixSeed(hash, hashText(file.text));
    return RuleSource{std::move(*rules), path.filename().string(), hash};
}

} // namespace helio
