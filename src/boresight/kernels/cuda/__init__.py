"""The same loops on a graphics card: one block of threads is one whole calibration, each thread one member.

What a thread does is written in the scalar steps of `boresight.kernels` (`carrying`, `trigonometry`, `random`,
`breeding`), compiled for the card by numba-cuda; only the order in which they are taken is written here. Read
`batches` (many calibrations of one shape as arrays), `costing` (what one member costs), `evolving` (the block),
`launching` and `running` (the host's side); beside them `linearising` and `refining`, least squares.

Only `batches` is imported before a card is asked for.
"""
