// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/base/hash.h"
#include "city/grammar/derive.h"
#include "city/grammar/occlusion.h"
#include "city/grammar/program.h"
#include "city/grammar/shape_state.h"
#include "city/grammar/trouble.h"

namespace helio::cga {

/// What an expression sees: the current shape, the parameters of the rule or function around it, and the shape's random
/// stream.
struct Env
{
    const ShapeState* shape = nullptr;
    std::span<const Value> parameters;
    Random* random = nullptr;
};

/// Evaluates expressions for one building. Errors go to Trouble; the value is then meaningless but of the asked kind.
class Evaluator
{
public:
    Evaluator(const Program& program, const Footprint& footprint, const DeriveOptions& options,
              const Occlusion& occlusion, u64 seed, Trouble& trouble);

    /// The shape on which attributes and constants are evaluated. Must be set before the first evaluation.
    void setInitialShape(const ShapeState& shape) { initial_ = shape; }

    Value evaluate(const Expr& expr, const Env& env);
    double number(const Expr& expr, const Env& env);
    bool truth(const Expr& expr, const Env& env);
    std::string text(const Expr& expr, const Env& env);
    /// Draws one of the branches of a percentage choice: index of the branch, percentages.size() for else.
    size_t draw(std::span<const Expr* const> percentages, const Env& env);

private:
    Value evaluateGlobal(const Expr& expr, const Env& env);
    Value globalValue(u32 index);
    Value globalBody(const Global& global, std::vector<Value> parameters, const Env& env);
    Value attributeValue(const Global& global, Value value);
    void checkRange(const Global& global, const Value& value);
    Value evaluateBinary(const Expr& expr, const Env& env);
    Value evaluateShape(ShapeAttribute attribute, const Env& env) const;
    Value evaluateChoice(const Expr& expr, const Env& env);
    Value charged(Value value, Place place);
    Value callBuiltin(const Expr& expr, const Env& env); ///< functions.cpp
    Value callMath(const Expr& expr, const Env& env);
    Value callText(const Expr& expr, const Env& env);      ///< text_functions.cpp
    Value callGeometry(const Expr& expr, const Env& env);  ///< geometry_functions.cpp
    Value callOcclusion(const Expr& expr, const Env& env); ///< geometry_functions.cpp
    Value finite(double value, const Expr& expr, std::string_view what);

    const Program& program_;
    const Footprint& footprint_;
    const DeriveOptions& options_;
    const Occlusion& occlusion_;
    u64 seed_;
    Trouble& trouble_;
    ShapeState initial_;
    enum class Progress : u8
    {
        None,
        Running,
        Done
    };
    std::vector<Progress> progress_; ///< per global: attributes and constants are evaluated once
    std::vector<Value> values_;
    u32 depth_ = 0, calls_ = 0;
};

} // namespace helio::cga
