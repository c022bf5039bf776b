/// @file
/// All methods of the chapter as a list, for tables, and by name, for --method.
#pragma once
#include <string>
#include <type_traits>
#include <utility>

#include "02_integrators/drag_variants.h"
#include "02_integrators/integrators.h"
#include "02_integrators/stiff_methods.h"
#include "common/errors.h"

namespace integrators {

/// The five that work on any problem.
template <class Work>
void for_each_method(Work&& work) {
    work(ExplicitEuler{}), work(SemiImplicitEuler{}), work(Leapfrog{}), work(Midpoint{}), work(RungeKutta4{});
}

/// And those for drag and stiffness.
template <class Work>
void for_every_method(Work&& work) {
    for_each_method(work);
    work(SemiImplicitEulerImplicitDrag{}), work(LeapfrogLaggedDrag{}), work(LeapfrogPredictedDrag{});
    work(ExponentialLeapfrog{}), work(ImplicitEuler{}), work(ImplicitMidpoint{});
}

/// Its name as one types it: "semi-implicit-Euler".
template <class Method>
std::string option_name() {
    std::string name;
    for (const char c : std::string(Method::kName))
        if (c != ',') name += c == ' ' ? '-' : c;
    return name;
}

/// Does a problem offer what implicit methods need?
template <class System, class = void>
constexpr bool kIsLinear = false;
template <class System>
constexpr bool kIsLinear<
    System, std::void_t<decltype(std::declval<System>().solve(1.0, 1.0, Vec<double, System::kDim>()))>> =
    true;
template <class Method>
constexpr bool kIsImplicit =
    std::is_same_v<Method, ImplicitEuler> || std::is_same_v<Method, ImplicitMidpoint>;

/// Calls `work(Method{})` with the method of that name.
/// @throws course::BadInput if there is none, or if the system's force is not linear and the method needs
/// that
template <class System, class Work>
void with_method(const std::string& name, Work&& work) {
    bool found = false;
    std::string names;
    for_every_method([&](auto method) {
        using Method = decltype(method);
        names += (names.empty() ? "" : ", ") + option_name<Method>();
        if (option_name<Method>() != name) return;
        found = true;
        if constexpr (kIsImplicit<Method> && !kIsLinear<System>)
            throw course::BadInput("--method " + name +
                                   " solves linear equations: this scene's force is not linear");
        else
            work(method);
    });
    if (!found) throw course::BadInput("there is no method '" + name + "': choose one of " + names);
}

}  // namespace integrators
