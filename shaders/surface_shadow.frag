#version 330 core
// Depth alone; no colour.

void main() {}
