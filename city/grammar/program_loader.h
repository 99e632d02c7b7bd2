// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

#include "city/grammar/error_list.h"
#include "city/grammar/parser.h"
#include "city/grammar/resolve.h"
#include "city/grammar/rules.h"

namespace helio::cga {

/// Puts a rule file, one of its styles and everything it imports together into one program, in which the names of
/// imported rules and globals start with the import's `id.`.
///
/// Attributes of imported files: a value in the import's parentheses is final. A name alone there, or `()` for all,
/// protects an attribute from what follows. Else an attribute of the same name that
/// the importing file declares (or the file that imports this one, and so on) stands for the imported one: they are the
/// same attribute. Else the imported attribute can be set by its name with the `id.`, and by properties of footprints
/// also without.
class ProgramLoader
{
public:
    /// `program` is empty but for its files, which may hold texts that are read again.
    ProgramLoader(Program& program, const RuleOptions& options, ErrorList& errors)
        : program_(program), options_(options), errors_(errors), names_(program.names)
    {
    }

    /// Loads files[0]. What is wrong is reported and left out.
    void load(const std::string& style);

    const BrokenNames& broken() const { return broken_; }

private:
    struct Importing
    {
        const ImportDeclaration* declaration = nullptr;
        u32 scope = 0; ///< of the importing file
    };

    void addFile(u32 file, const std::string& prefix, const Importing& importing);
    static std::vector<StyleSection*> chainOf(ParsedFile& parsed, const std::string& style);
    void addRules(const std::vector<StyleSection*>& chain, u32 scope);
    void addGlobals(const std::vector<StyleSection*>& chain, u32 scope, const Importing& importing);
    void checkOverrides(const Importing& importing, u32 scope, u32 file);
    u32 attributeOfImporter(const std::string& name, u32 scope) const;
    void addImport(const ImportDeclaration& declaration, u32 scope, u32 file);
    u32 readImport(const ImportDeclaration& declaration, const std::string& path);

    Program& program_;
    const RuleOptions& options_;
    ErrorList& errors_;
    NameTable names_;
    BrokenNames broken_;
    std::vector<u32> importerOf_;      ///< per scope: the scope of the importing file
    std::set<std::string> attributes_; ///< full names of what the files declare with attr, overridden or not
    std::vector<u32> open_;            ///< files whose imports are being read, from the rule file on
    u64 bytes_ = 0;
};

} // namespace helio::cga
