// Half of a steel roller on a rubber pad; plane strain (roller_on_pad.yaml)
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 0.5 / refine; coarse = 3 / refine; w = 30; h = 8; r = 12;
Point(1) = {0, 0, 0, 2 * fine}; Point(2) = {w, 0, 0, coarse}; Point(3) = {w, h, 0, coarse}; Point(4) = {0, h, 0, fine};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Point(11) = {0, h, 0, fine}; Point(12) = {0, h + r, 0, coarse}; Point(13) = {r, h + r, 0, coarse};
Circle(11) = {11, 12, 13}; Line(12) = {13, 12}; Line(13) = {12, 11};
Curve Loop(2) = {11 : 13}; Plane Surface(2) = {2};
Physical Surface("pad") = {1}; Physical Surface("roller") = {2};
Physical Curve("base") = {1}; Physical Curve("top") = {3}; Physical Curve("tread") = {11}; Physical Curve("load") = {12};
Physical Curve("sym") = {4, 13};
