// A snap hook in front of a catch, plane strain; the hook moves to the right. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
L = 20;              // arm
t = 2;               // its thickness
h = 1.5;             // height of the hook over the arm
lead = 30 * Pi / 180;   // slope of the hook's front
back = 50 * Pi / 180;   // slope of its back
land = 0.8;          // flat between them
r = 0.4;             // rounding of the hook's edges
fine = 0.12 / refine;
coarse = 0.7 / refine;

// arm: from x = 0 (root) to the hook; upper face at y = t
xb = L;                              // foot of the back
xt1 = xb + h / Tan(back);            // sharp upper edges
xt2 = xt1 + land + 2 * r * 0.5;
xf = xt2 + (h + 0.6) / Tan(lead);    // the front ends 0.6 below the arm's upper face
// roundings: tangent lengths
g1 = r * Tan(back / 2);
g2 = r * Tan(lead / 2);
Point(1) = {0, 0, 0, coarse};
Point(2) = {xf, 0, 0, coarse};
Point(3) = {xf, t - 0.6, 0, fine};
Point(4) = {xt2 + g2 * Cos(lead), t + h - g2 * Sin(lead), 0, fine};
Point(5) = {xt2 - g2, t + h - r, 0, fine};
Point(6) = {xt2 - g2, t + h, 0, fine};
Point(7) = {xt1 + g1, t + h, 0, fine};
Point(8) = {xt1 + g1, t + h - r, 0, fine};
Point(9) = {xt1 - g1 * Cos(back), t + h - g1 * Sin(back), 0, fine};
Point(10) = {xb, t, 0, fine};
Point(11) = {0, t, 0, coarse};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Circle(4) = {4, 5, 6};
Line(5) = {6, 7};
Circle(6) = {7, 8, 9};
Line(7) = {9, 10};
Line(8) = {10, 11};
Line(9) = {11, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8, 9};
Plane Surface(1) = {1};

// catch: a bar across the way, above; its lower edges are rounded, its lower face stands 0.1 over the arm
c0 = xf - 0.6 / Tan(lead);   // left face; it meets the front above the arm's upper face
cw = 2;                      // width
ch = 4;                      // height
rc = 0.5;
y0 = t + 0.1;
Point(21) = {c0 + rc, y0, 0, fine};
Point(22) = {c0 + cw - rc, y0, 0, fine};
Point(23) = {c0 + cw - rc, y0 + rc, 0, fine};
Point(24) = {c0 + cw, y0 + rc, 0, fine};
Point(25) = {c0 + cw, y0 + ch, 0, coarse};
Point(26) = {c0, y0 + ch, 0, coarse};
Point(27) = {c0, y0 + rc, 0, fine};
Point(28) = {c0 + rc, y0 + rc, 0, fine};
Line(21) = {21, 22};
Circle(22) = {22, 23, 24};
Line(23) = {24, 25};
Line(24) = {25, 26};
Line(25) = {26, 27};
Circle(26) = {27, 28, 21};
Curve Loop(2) = {21, 22, 23, 24, 25, 26};
Plane Surface(2) = {2};

Physical Surface("hook") = {1};
Physical Surface("catch") = {2};
Physical Curve("root") = {9};
Physical Curve("hook_face") = {3, 4, 5, 6, 7, 8};
Physical Curve("catch_face") = {21, 22, 23, 25, 26};
Physical Curve("catch_top") = {24};
