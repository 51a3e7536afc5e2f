"""drypoint in vpype: `drypoint` draws a photograph into the pipeline, `dpsort` orders the paths of layers."""
