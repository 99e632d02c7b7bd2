// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/program_loader.h"

#include <algorithm>
#include <filesystem>

#include "city/grammar/limits.h"

namespace helio::cga {

namespace {

/// The path of an import, from where the importing file's path starts.
std::string resolvePath(const std::string& importing, const std::string& path)
{
    return (std::filesystem::path(importing).parent_path() / path).lexically_normal().generic_string();
}

bool isPath(const std::string& path)
{
    constexpr size_t kMaxPath = 1000;
    return !path.empty() && path.size() <= kMaxPath && path[0] != '/' &&
           std::all_of(path.begin(), path.end(), [](char c) { return u8(c) >= ' '; });
}

std::string listOf(const std::vector<std::string>& names)
{
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

} // namespace

void ProgramLoader::load(const std::string& style)
{
    const ImportDeclaration root{{}, "", style, program_.files[0].name, false, {}};
    addFile(0, "", {&root, 0});
    if (program_.rules.empty() && errors_.empty())
        errors_.report({}, "the file declares no rule: write at least  Lot --> ...");
}

void ProgramLoader::addFile(u32 file, const std::string& prefix, const Importing& importing)
{
    const u32 scope = u32(program_.scopes.size());
    program_.scopes.push_back(prefix);
    importerOf_.push_back(importing.scope);
    ParsedFile parsed = parseFile(program_.files[file].text, file, names_, errors_);
    for (const std::string& name : parsed.brokenNames) broken_.names.insert(prefix + name);
    broken_.unknown = broken_.unknown || parsed.namesLost;

    const ImportDeclaration& declaration = *importing.declaration;
    const std::string style = declaration.style.empty() ? "Default" : declaration.style;
    std::vector<std::string> styles;
    for (const StyleSection& section : parsed.sections) styles.push_back(section.name);
    if (std::find(styles.begin(), styles.end(), style) == styles.end())
        errors_.report(declaration.place,
                       concat("'", program_.files[file].name, "' has no style '", style, "', but ", listOf(styles)));
    if (scope == 0) {
        program_.style = style;
        program_.styles = std::move(styles);
    }
    const std::vector<StyleSection*> chain = chainOf(parsed, style);
    addRules(chain, scope);
    addGlobals(chain, scope, importing);
    if (!parsed.namesLost) checkOverrides(importing, scope, file);

    open_.push_back(file);
    std::set<std::string> ids;
    for (const ImportDeclaration& inner : parsed.imports) {
        if (ids.insert(inner.id).second)
            addImport(inner, scope, file);
        else
            errors_.report(inner.place, concat("two imports are called '", inner.id, "'"));
    }
    open_.pop_back();
}

/// The sections that make up a style: Default, what it extends, itself.
std::vector<StyleSection*> ProgramLoader::chainOf(ParsedFile& parsed, const std::string& style)
{
    std::vector<StyleSection*> chain;
    std::string wanted = style;
    for (size_t k = parsed.sections.size(); k-- > 1;) { // a style only extends those before it
        if (parsed.sections[k].name != wanted) continue;
        chain.push_back(&parsed.sections[k]);
        wanted = parsed.sections[k].base;
    }
    chain.push_back(&parsed.sections[0]);
    std::reverse(chain.begin(), chain.end());
    return chain;
}

void ProgramLoader::addRules(const std::vector<StyleSection*>& chain, u32 scope)
{
    u32 start = kNoIndex;
    for (StyleSection* section : chain) {
        bool marked = false;
        for (Rule& rule : section->rules) {
            const std::string name = program_.scopes[scope] + program_.names[rule.name];
            rule.name = names_.intern(name);
            rule.scope = scope;
            const auto [it, added] =
                program_.ruleIndex.emplace(std::pair(name, u32(rule.parameters.size())), u32(program_.rules.size()));
            for (const Annotation& annotation : rule.annotations) {
                if (marked || annotation.name != "StartRule") continue;
                marked = true;
                start = it->second;
            }
            if (added)
                program_.rules.push_back(std::move(rule));
            else
                program_.rules[it->second] = std::move(rule);
        }
    }
    if (scope == 0) program_.startRule = start;
}

void ProgramLoader::addGlobals(const std::vector<StyleSection*>& chain, u32 scope, const Importing& importing)
{
    const std::string prefix = program_.scopes[scope];
    std::vector<Global> globals;
    std::map<std::pair<std::string, u32>, size_t> index;
    for (StyleSection* section : chain) {
        for (Global& global : section->globals) {
            const auto [it, added] =
                index.emplace(std::pair(global.name, u32(global.parameters.size())), globals.size());
            if (added) {
                globals.push_back(std::move(global));
                continue;
            }
            Global& replaced = globals[it->second];
            if (global.annotations.empty()) global.annotations = std::move(replaced.annotations);
            replaced = std::move(global);
        }
    }
    std::map<std::string_view, const ImportDeclaration::Override*> overrides;
    for (const ImportDeclaration::Override& entry : importing.declaration->overrides)
        overrides.emplace(entry.name, &entry);
    for (Global& global : globals) {
        const std::pair key(prefix + global.name, u32(global.parameters.size()));
        global.scope = scope;
        if (global.kind == GlobalKind::Attribute && key.second == 0) {
            attributes_.insert(key.first);
            if (const auto entry = overrides.find(global.name); entry != overrides.end()) {
                if (entry->second->value) {
                    global.kind = GlobalKind::Constant;
                    global.value = *entry->second->value;
                    global.source = entry->second->source;
                    global.scope = importing.scope;
                    global.locals.clear();
                    global.localNames.clear();
                }
            } else if (importing.declaration->protectsAll) {
                // it stays what its file makes it
            } else if (const u32 same = attributeOfImporter(global.name, scope); same != kNoIndex) {
                program_.globalIndex.emplace(key, same);
                continue;
            }
        }
        global.name = key.first;
        program_.globalIndex.emplace(key, u32(program_.globals.size()));
        program_.globals.push_back(std::move(global));
    }
}

void ProgramLoader::checkOverrides(const Importing& importing, u32 scope, u32 file)
{
    std::set<std::string_view> seen;
    for (const ImportDeclaration::Override& entry : importing.declaration->overrides) {
        const std::string name = program_.scopes[scope] + entry.name;
        if (!seen.insert(entry.name).second) errors_.report(entry.place, concat("'", entry.name, "' is set twice"));
        if (attributes_.count(name) == 0 && broken_.names.count(name) == 0)
            errors_.report(entry.place, concat("'", program_.files[file].name, "' declares no attribute '", entry.name,
                                               "' that could be set here"));
    }
}

/// The attribute of this name of the nearest file around `scope` that declares one.
u32 ProgramLoader::attributeOfImporter(const std::string& name, u32 scope) const
{
    while (scope != 0) {
        scope = importerOf_[scope];
        const std::string full = program_.scopes[scope] + name;
        if (attributes_.count(full) == 0) continue;
        const auto found = program_.globalIndex.find({full, 0});
        if (found != program_.globalIndex.end()) return found->second;
    }
    return kNoIndex;
}

void ProgramLoader::addImport(const ImportDeclaration& declaration, u32 scope, u32 file)
{
    const std::string prefix = program_.scopes[scope] + declaration.id + ".";
    const u32 imported = readImport(declaration, resolvePath(program_.files[file].name, declaration.path));
    if (imported == kNoIndex) {
        broken_.prefixes.insert(prefix);
        return;
    }
    program_.imports.push_back({u32(program_.scopes.size()), imported, scope, declaration.style});
    addFile(imported, prefix, {&declaration, scope});
}

/// The file of an import; kNoIndex, with an error, if it cannot be had.
u32 ProgramLoader::readImport(const ImportDeclaration& declaration, const std::string& path)
{
    const auto refuse = [&](std::string_view why) {
        errors_.report(declaration.place, concat("import \"", declaration.path.substr(0, 200), "\": ", why));
        return kNoIndex;
    };
    if (!isPath(declaration.path)) return refuse("write the file's path relative to this file");
    for (size_t k = 0; k < open_.size(); ++k) {
        if (program_.files[open_[k]].name != path) continue;
        std::string loop;
        for (; k < open_.size(); ++k) loop += program_.files[open_[k]].name + " -> ";
        return refuse(concat("the files import each other: ", loop, path));
    }
    if (open_.size() > kMaxImportDepth) return refuse(concat("imports nest deeper than ", kMaxImportDepth, " levels"));
    if (program_.imports.size() >= kMaxImports)
        return refuse(concat("the rules import more than ", kMaxImports, " files"));

    u32 file = 0;
    while (file < program_.files.size() && program_.files[file].name != path) ++file;
    if (file == program_.files.size()) {
        if (!options_.readImport) return refuse("these rules are read without a folder, so they cannot import files");
        Result<std::string> text = options_.readImport(path);
        if (!text) return refuse(text.error().message);
        program_.files.push_back({path, std::move(*text)});
    }
    bytes_ += program_.files[file].text.size();
    if (bytes_ > kMaxSourceBytes)
        return refuse(concat("the imported files have more than ", kMaxSourceBytes, " bytes together"));
    return file;
}

} // namespace helio::cga
