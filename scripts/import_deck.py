"""Turns a deck of Abaqus or CalculiX into a scene and a mesh for Burnish, and says what it did not take.
    python scripts/import_deck.py DECK.inp [SCENE.yaml]
`burnish -import DECK.inp` calls it. The scene is written as DECK.yaml in the present folder, unless another name is
given, with the mesh DECK.msh beside it. Files that are there are not overwritten. Lines that start with `missing:` name
cards whose effect the scene lacks, so that its answer will differ from the deck's; lines that start with `changed:`
name what is done in another way."""
import argparse
import pathlib
import sys

from meshfiles.deck import Deck
from meshfiles.deckscene import DeckScene
from meshfiles.mesh import MeshError


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path, nargs="?")
    args = parser.parse_args()
    scene = args.scene or pathlib.Path(args.deck.stem + ".yaml")
    mesh = scene.with_suffix(".msh")
    for file in (scene, mesh):
        if file.exists():
            sys.exit(f"burnish: '{file}' is there already; allowed: a new name, as in -import {args.deck} NEW.yaml [B147]")
    try:
        made = DeckScene(Deck(args.deck))
        text = made.text(mesh.name)
    except MeshError as error:
        sys.exit(f"burnish: '{args.deck}' is not taken: {error} [B124]")
    made.mesh.write(mesh)
    scene.write_text(text)
    for line in made.remarks():
        print(line)
    print(f"written: {scene}, {mesh}; look at them with burnish -check {scene}")


if __name__ == "__main__":
    main()
