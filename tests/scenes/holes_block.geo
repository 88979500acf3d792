// A rubber block with three by three round holes. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, size = {1, Name "element size"}, pitch = {10, Name "between holes"},
  radius = {3.5, Name "of the holes"}, n = {3, Name "holes in a row"}
];
SetFactory("Built-in");
w = n * pitch; h = size / refine;
Mesh.MeshSizeExtendFromBoundary = 1;
Point(1) = {0, 0, 0, h}; Point(2) = {w, 0, 0, h}; Point(3) = {w, w, 0, h}; Point(4) = {0, w, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
loops[] = {};
For i In {0:n-1}
  For j In {0:n-1}
    k = 100 + 10 * (n * i + j); x = (i + 0.5) * pitch; y = (j + 0.5) * pitch;
    Point(k) = {x, y, 0, h};
    Point(k + 1) = {x + radius, y, 0, h}; Point(k + 2) = {x, y + radius, 0, h};
    Point(k + 3) = {x - radius, y, 0, h}; Point(k + 4) = {x, y - radius, 0, h};
    Circle(k + 1) = {k + 1, k, k + 2}; Circle(k + 2) = {k + 2, k, k + 3};
    Circle(k + 3) = {k + 3, k, k + 4}; Circle(k + 4) = {k + 4, k, k + 1};
    Curve Loop(k) = {k + 1 : k + 4};
    loops[] += {k};
  EndFor
EndFor
Plane Surface(1) = {1, loops[]};
Physical Surface("block") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
