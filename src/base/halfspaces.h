/* The point nearest to a given one in the intersection of half-spaces. Plain C, few dimensions, many half-spaces. */
#pragma once

int HalfspacesProject(int dim, int n, const double *normal, const double *bound, double tolerance, double y[]);
