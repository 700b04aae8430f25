"""Misspelt calls: a checker finds each line that ends in `# wrong`, and no other."""

import weft


def misspell(cloth: weft.SyncClient) -> None:
    cloth.puase()  # wrong
    cloth.set(wnd=[1, 0, 0])  # wrong
    cloth.set(over_budget="stop")  # wrong
    cloth.set(fabric={"frction": 0.2})  # wrong
    cloth.set(fans=[{"position": [0, 1, 2]}])  # wrong
    cloth.advance("3")  # wrong
    cloth.advance(3, frames="first")  # wrong
    cloth.pick([0, 1, 3])  # wrong
    cloth.query("energy")  # wrong
    print(cloth.query("energies")["kinetc"])  # wrong
    print(cloth.hash()["hash"])  # wrong
    print(cloth.pause()["tikc"])  # wrong
    print(cloth.drag(7, raduis=0.05))  # wrong
    with cloth.drag(7) as hand:
        hand.mvoe([0, 1, 0])  # wrong
    print(cloth.next_frame().tik)  # wrong
    print(cloth.mesh["cloth"])  # wrong


async def misspell_waiting(cloth: weft.Client) -> None:
    await cloth.puase()  # wrong
    await cloth.gripper("g", openning=0)  # wrong
    print((await cloth.step(3))["untl"])  # wrong
    print((await cloth.query("grippers"))[0]["troque"])  # wrong
