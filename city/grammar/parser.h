// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

#include "city/grammar/error_list.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// `import id(style) : "file.cga" (attribute = value, protected, ..)`.
struct ImportDeclaration
{
    struct Override
    {
        Place place;
        std::string name;
        std::optional<Expr> value; ///< in the names of the importing file; none: the attribute keeps its own
        std::string source;
    };
    Place place;
    std::string id;
    std::string style;        ///< empty: Default
    std::string path;         ///< as written
    bool protectsAll = false; ///< `()`: all attributes keep their own values
    std::vector<Override> overrides;
};

/// What one style declares. The first section of a file is Default, with everything before the first `style`.
struct StyleSection
{
    Place place;
    std::string name = "Default";
    std::string base = "Default";
    std::vector<Rule> rules;     ///< name: into the names that parseFile was given
    std::vector<Global> globals; ///< name: without an import's id
};

/// A file after parsing, with nothing looked up yet.
struct ParsedFile
{
    std::vector<StyleSection> sections; ///< at least Default
    std::vector<ImportDeclaration> imports;
    /// Names of declarations that could not be read: what uses them makes no second mistake.
    std::set<std::string> brokenNames;
    bool namesLost = false; ///< a declaration was so broken that not even its name is known
};

/// The names of rules and terminals, numbered.
class NameTable
{
public:
    explicit NameTable(std::vector<std::string>& names) : names_(names) {}
    /// The number of a name, as an index into the names.
    u32 intern(const std::string& name);

private:
    std::vector<std::string>& names_;
    std::map<std::string, u32> index_;
};

/// Parses the text of a file. Any text gives a ParsedFile; what is wrong in it is reported and left out.
ParsedFile parseFile(std::string_view text, u32 file, NameTable& names, ErrorList& errors);

} // namespace helio::cga
