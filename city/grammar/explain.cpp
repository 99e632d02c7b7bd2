// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/explain.h"

#include <algorithm>
#include <limits>
#include <map>

#include "city/grammar/program.h"

namespace helio {

namespace {

using namespace cga;

std::string join(const std::vector<std::string>& parts, std::string_view separator)
{
    std::string all;
    for (const std::string& part : parts) {
        if (!all.empty()) all += separator;
        all += part;
    }
    return all;
}

void addOnce(std::vector<std::string>& list, const std::string& name)
{
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

// ---- attributes

/// Where a user interface would show an attribute.
struct Position
{
    static constexpr double kLast = std::numeric_limits<double>::infinity();
    std::string group; ///< names of nested groups, separated by " / "
    double groupOrder = kLast, order = kLast;
};

Position positionOf(const Global& attribute)
{
    Position position;
    for (const Annotation& annotation : attribute.annotations) {
        const bool group = annotation.name == "Group";
        if (!group && annotation.name != "Order") continue;
        for (const Annotation::Argument& argument : annotation.arguments) {
            if (argument.number)
                (group ? position.groupOrder : position.order) = *argument.number;
            else if (group)
                position.group += (position.group.empty() ? "" : " / ") + argument.text;
        }
    }
    return position;
}

std::vector<std::string> describeArguments(const Annotation& annotation)
{
    std::vector<std::string> arguments;
    for (const Annotation::Argument& argument : annotation.arguments)
        arguments.push_back(argument.key.empty() ? argument.text : argument.key + "=" + argument.text);
    return arguments;
}

std::string describeRange(const Annotation& range)
{
    const auto isText = [](const Annotation::Argument& argument) { return argument.key.empty() && !argument.number; };
    if (range.arguments.size() > 3 || std::any_of(range.arguments.begin(), range.arguments.end(), isText))
        return "one of " + join(describeArguments(range), ", "); // as old files write @Enum
    std::string low, high, step;
    size_t unnamed = 0;
    for (const Annotation::Argument& argument : range.arguments) {
        if (argument.key == "min" || (argument.key.empty() && unnamed == 0)) low = argument.text;
        if (argument.key == "max" || (argument.key.empty() && unnamed == 1)) high = argument.text;
        if (argument.key == "stepsize" || (argument.key.empty() && unnamed == 2)) step = argument.text;
        unnamed += argument.key.empty() ? 1u : 0u;
    }
    std::string text = low.empty()    ? concat("at most ", high)
                       : high.empty() ? concat("at least ", low)
                                      : low + " to " + high;
    if (!step.empty()) text += " in steps of " + step;
    return text;
}

std::string describe(const Annotation& annotation)
{
    const std::vector<std::string> arguments = describeArguments(annotation);
    if (annotation.name == "Group" || annotation.name == "Order") return {};
    if (annotation.name == "Range" && !arguments.empty()) return describeRange(annotation);
    if (annotation.name == "Enum") return "one of " + join(arguments, ", ");
    if (annotation.name == "Description") return join(arguments, " ");
    return arguments.empty() ? "@" + annotation.name : concat("@", annotation.name, "(", join(arguments, ", "), ")");
}

std::string explainAttributes(const Program& program)
{
    struct Row
    {
        Position position;
        size_t groupAt; ///< of the group's first attribute: groups without an order stay in the order of the file
        const Global* attribute;
    };
    std::vector<Row> rows;
    std::map<std::string, std::pair<double, size_t>> groups; // order and first attribute
    size_t width = 0;
    for (const Global& global : program.globals) {
        if (global.kind != GlobalKind::Attribute) continue;
        Row row{positionOf(global), 0, &global};
        auto& [order, first] =
            groups.emplace(row.position.group, std::pair(Position::kLast, rows.size())).first->second;
        order = std::min(order, row.position.groupOrder);
        row.groupAt = first;
        rows.push_back(std::move(row));
        width = std::max(width, std::min<size_t>(global.name.size() + global.source.size() + 3, 40));
    }
    std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) {
        const double orderA = groups[a.position.group].first, orderB = groups[b.position.group].first;
        return std::tuple(orderA, a.groupAt, a.position.order) < std::tuple(orderB, b.groupAt, b.position.order);
    });

    std::string text = "attributes\n";
    for (size_t k = 0; k < rows.size(); ++k) {
        const std::string& group = rows[k].position.group;
        if (!group.empty() && (k == 0 || rows[k - 1].position.group != group)) text += concat("  ", group, "\n");
        std::string line =
            concat(group.empty() ? "  " : "    ", rows[k].attribute->name, " = ", rows[k].attribute->source);
        std::vector<std::string> notes;
        for (const Annotation& annotation : rows[k].attribute->annotations)
            if (std::string note = describe(annotation); !note.empty()) notes.push_back(std::move(note));
        if (!notes.empty()) {
            line.resize(std::max(line.size(), width + 4), ' ');
            line += concat("  (", join(notes, "; "), ")");
        }
        text += line + '\n';
    }
    return rows.empty() ? "" : text + '\n';
}

std::string explainFunctions(const Program& program)
{
    std::string text;
    for (const Global& global : program.globals) {
        if (global.kind == GlobalKind::Attribute) continue;
        text += concat("  ", global.kind == GlobalKind::Constant ? "const " : "", global.name);
        if (!global.parameters.empty()) text += concat("(", join(global.parameters, ", "), ")");
        text += concat(" = ", global.source, "\n");
    }
    return text.empty() ? "" : "functions and constants\n" + text + '\n';
}

// ---- rules

/// What the body of a rule names.
struct Uses
{
    std::vector<std::string> successors, operations; ///< in the order of the text, each once
    std::vector<u32> rules;
};

class UseCollector
{
public:
    explicit UseCollector(const Program& program) : program_(program) {}

    Uses collect(const Body& body)
    {
        uses_ = {};
        add(body);
        return std::move(uses_);
    }

private:
    void add(const Body& body)
    {
        for (const Body& inner : body.bodies) add(inner);
        for (const Statement& statement : body.statements) {
            for (const Body& pushed : statement.body) add(pushed);
            if (statement.kind == StatementKind::Push) continue;
            const std::string& name = program_.names[statement.name];
            if (statement.kind == StatementKind::Operation) {
                addOnce(uses_.operations, name);
            } else if (statement.rule == kNoIndex) {
                addOnce(uses_.successors, name + ".");
            } else {
                addOnce(uses_.successors, name);
                uses_.rules.push_back(statement.rule);
            }
            if (statement.block) add(*statement.block);
        }
    }

    void add(const Block& block)
    {
        for (const BlockElement& element : block.elements) {
            if (element.nested)
                add(*element.nested);
            else
                add(element.body);
        }
    }

    const Program& program_;
    Uses uses_;
};

/// Which rules are reached from where a footprint, or a face of a given building, starts.
std::vector<bool> findReached(const Program& program, const std::vector<Uses>& uses)
{
    std::vector<bool> reached(program.rules.size(), false);
    std::vector<u32> open;
    const auto visit = [&](u32 rule) {
        if (reached[rule]) return;
        reached[rule] = true;
        open.push_back(rule);
    };
    if (program.startRule != kNoIndex) visit(program.startRule);
    for (const char* name : {"WallSurface", "RoofSurface", "GroundSurface"})
        if (const auto rule = program.ruleIndex.find({name, 0}); rule != program.ruleIndex.end()) visit(rule->second);
    while (!open.empty()) {
        const u32 rule = open.back();
        open.pop_back();
        for (const u32 successor : uses[rule].rules) visit(successor);
    }
    return reached;
}

std::string explainGraph(const Program& program)
{
    UseCollector collector(program);
    std::vector<Uses> uses;
    for (const Rule& rule : program.rules) uses.push_back(collector.collect(rule.body));
    const std::vector<bool> reached = findReached(program, uses);
    std::string text = "rules\n";
    for (size_t k = 0; k < program.rules.size(); ++k) {
        const Rule& rule = program.rules[k];
        text += concat("  ", program.names[rule.name]);
        if (!rule.parameters.empty()) text += concat("(", join(rule.parameters, ", "), ")");
        text += concat(" -> ", uses[k].successors.empty() ? "-" : join(uses[k].successors, ", "));
        if (!uses[k].operations.empty()) text += concat("  [", join(uses[k].operations, " "), "]");
        if (!reached[k]) text += "  (never reached)";
        text += '\n';
    }
    return text;
}

} // namespace

std::string explainRules(const RuleSet& rules)
{
    const Program& program = rules.program();
    std::string text = concat(program.fileName, ": ", program.rules.size(), " rules, start rule ",
                              program.startRule == kNoIndex ? "none: name one Lot, or mark one with @StartRule"
                                                            : program.names[program.rules[program.startRule].name],
                              "\n");
    if (program.styles.size() > 1)
        text += concat("styles: ", join(program.styles, ", "), "; in force: ", program.style, "\n");
    for (const Import& item : program.imports) {
        const std::string& scope = program.scopes[item.scope];
        text += concat("import ", scope.substr(0, scope.size() - 1), ": ", program.files[item.file].name,
                       item.style.empty() ? "" : ", style " + item.style, "\n");
    }
    return text + '\n' + explainAttributes(program) + explainFunctions(program) + explainGraph(program);
}

} // namespace helio
