/// @file
/// min and max, which CUDA has in the global namespace.
#pragma once
#include <cmath>

// CUDA's min and max live in the global namespace, for numbers of one type and for signed with unsigned,
// which compare as unsigned.
constexpr int min(int a, int b) {
    return b < a ? b : a;
}
constexpr int max(int a, int b) {
    return a < b ? b : a;
}
constexpr unsigned min(unsigned a, unsigned b) {
    return b < a ? b : a;
}
constexpr unsigned max(unsigned a, unsigned b) {
    return a < b ? b : a;
}
constexpr unsigned min(int a, unsigned b) {
    return min(static_cast<unsigned>(a), b);
}
constexpr unsigned max(int a, unsigned b) {
    return max(static_cast<unsigned>(a), b);
}
constexpr unsigned min(unsigned a, int b) {
    return min(a, static_cast<unsigned>(b));
}
constexpr unsigned max(unsigned a, int b) {
    return max(a, static_cast<unsigned>(b));
}
constexpr long min(long a, long b) {
    return b < a ? b : a;
}
constexpr long max(long a, long b) {
    return a < b ? b : a;
}
constexpr unsigned long min(unsigned long a, unsigned long b) {
    return b < a ? b : a;
}
constexpr unsigned long max(unsigned long a, unsigned long b) {
    return a < b ? b : a;
}
constexpr long long min(long long a, long long b) {
    return b < a ? b : a;
}
constexpr long long max(long long a, long long b) {
    return a < b ? b : a;
}
constexpr unsigned long long min(unsigned long long a, unsigned long long b) {
    return b < a ? b : a;
}
constexpr unsigned long long max(unsigned long long a, unsigned long long b) {
    return a < b ? b : a;
}
// As fminf and fmaxf: if one is a NaN, the other.
inline float min(float a, float b) {
    return fminf(a, b);
}
inline float max(float a, float b) {
    return fmaxf(a, b);
}
inline double min(double a, double b) {
    return fmin(a, b);
}
inline double max(double a, double b) {
    return fmax(a, b);
}
inline double min(float a, double b) {
    return fmin(a, b);
}
inline double max(float a, double b) {
    return fmax(a, b);
}
inline double min(double a, float b) {
    return fmin(a, b);
}
inline double max(double a, float b) {
    return fmax(a, b);
}
