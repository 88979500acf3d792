// Two blocks that share their nodes, for meshes that are written in other formats.
n = 3;
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1, 1, 1, 0.5};
Coherence;
Transfinite Curve {:} = n;
Transfinite Surface {:};
Transfinite Volume {:};
Recombine Surface {:};
Physical Volume("low") = {1};
Physical Volume("high") = {2};
Physical Surface("bottom") = Surface In BoundingBox {-0.1, -0.1, -0.1, 1.1, 1.1, 0.1};
Physical Surface("top") = Surface In BoundingBox {-0.1, -0.1, 1.4, 1.1, 1.1, 1.6};
Physical Surface("left") = Surface In BoundingBox {-0.1, -0.1, -0.1, 0.1, 1.1, 1.6};
Physical Surface("front") = Surface In BoundingBox {-0.1, -0.1, -0.1, 1.1, 0.1, 1.6};
