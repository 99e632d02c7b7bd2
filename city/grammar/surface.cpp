// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that say what the current shape looks like: color and set.
#include <algorithm>

#include "city/grammar/interpreter.h"
#include "city/model/materials.h"

namespace helio::cga {

void Interpreter::setColor(const Statement& statement, ShapeState& state, Frame& frame)
{
    if (statement.args.size() >= 3) {
        glm::dvec3 color;
        for (int k = 0; k < 3; ++k) color[k] = evaluator_.number(statement.args[size_t(k)].value, env(state, frame));
        state.look.color = glm::clamp(color, 0.0, 1.0);
        if (statement.args.size() == 4)
            state.look.opacity = std::clamp(evaluator_.number(statement.args[3].value, env(state, frame)), 0.0, 1.0);
        return;
    }
    if (statement.args.size() == 2)
        return trouble_.fail(statement.place, "color takes \"#rrggbb\" or three numbers from 0 to 1");
    const std::string text = evaluator_.text(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    state.look.color = parseColor(text);
    if (!state.look.color)
        trouble_.fail(statement.place, concat("'", text, "' is no colour: write \"#rrggbb\" with hexadecimal digits"));
}

void Interpreter::set(const Statement& statement, ShapeState& state, Frame& frame)
{
    const Expr& expr = statement.args[0].value;
    const auto number = [&] { return evaluator_.number(expr, env(state, frame)); };
    const auto target = SetTarget(std::min(statement.mode, u32(SetTarget::FirstGlobal)));
    switch (target) {
    case SetTarget::ColorR:
    case SetTarget::ColorG:
    case SetTarget::ColorB: {
        glm::dvec3 color = state.look.color.value_or(glm::dvec3(1.0));
        color[int(target) - int(SetTarget::ColorR)] = std::clamp(number(), 0.0, 1.0);
        state.look.color = color;
        return;
    }
    case SetTarget::ColorRgb:
        return setColor(statement, state, frame);
    case SetTarget::Name:
        state.look.material = evaluator_.text(expr, env(state, frame));
        if (!state.look.material.empty() && !findMaterial(state.look.material))
            trouble_.warn(statement.place, concat("material '", state.look.material,
                                                  "' is not in the table of city/model/materials.cpp: its reflectance "
                                                  "comes from the colour"));
        return;
    case SetTarget::EmissiveR:
    case SetTarget::EmissiveG:
    case SetTarget::EmissiveB: {
        const double emissive = number();
        if (emissive < 0.0)
            return trouble_.fail(expr.place, concat("an emission must not be negative: ", emissive, " W/m2"));
        state.look.emissive[int(target) - int(SetTarget::EmissiveR)] = emissive;
        return;
    }
    case SetTarget::Opacity:
        state.look.opacity = std::clamp(number(), 0.0, 1.0);
        if (state.look.opacity < 1.0)
            trouble_.warn(statement.place,
                          "material.opacity is kept for the rules to read: surfaces are opaque to light");
        return;
    case SetTarget::TrimVertical:
        state.trimVertical = evaluator_.truth(expr, env(state, frame));
        return;
    case SetTarget::TrimHorizontal:
        state.trimHorizontal = evaluator_.truth(expr, env(state, frame));
        return;
    case SetTarget::Seedian: {
        const double seed = number();
        state.seedian = seed;
        frame.seed = mixSeed(seed_, hashText(toText(Value(seed)))); // children roll from the rule's own seed
        frame.random = Random(frame.seed);
        return;
    }
    case SetTarget::Ignored:
        return;
    case SetTarget::FirstGlobal:
        break;
    }
    auto attributes = std::make_shared<std::map<u32, Value>>();
    if (state.attributes) {
        trouble_.spend(statement.place, state.attributes->size()); // shapes share the map, so it is copied
        *attributes = *state.attributes;
    }
    (*attributes)[statement.mode - u32(SetTarget::FirstGlobal)] = evaluator_.evaluate(expr, env(state, frame));
    state.attributes = std::move(attributes);
}

} // namespace helio::cga
